// The camera of a 3D scene: around a focal point, or from the top without perspective, as in RViz.
// Without a document. Its coordinates have their origin at the target frame and the axes of the fixed one.

/** @import {Vec2, Vec3, Wxyz} from "../page/web/types.js" */

/**
 * @typedef {{
 *   type: "Orbit" | "TopDownOrtho", target_frame: string, distance: number, yaw: number,
 *   pitch: number, focal_point: Vec3,
 * }} SceneCamera
 */

const HALF_VIEW = Math.tan(Math.PI / 8); // of the field of view of RViz, 45°
const NARROW = Math.tan(Math.PI / 360); // a field of view of 1°, from far above
const TURN = 0.005; // rad/px, as RViz
const MAX_PITCH = 1.5698;
const FAR = 1e5; // metres
const LEAST = 0.01;
const MOST = 1e6;

/** @type {SceneCamera} */
export const STANDARD = {
  type: "Orbit",
  target_frame: "<Fixed Frame>",
  distance: 10,
  yaw: Math.PI / 4,
  pitch: Math.PI / 4,
  focal_point: [0, 0, 0],
};

/** @param {SceneCamera} camera */
const pitchOf = ({ type, pitch }) => (type === "TopDownOrtho" ? Math.PI / 2 : pitch);

/**
 * The rotation of a camera, x to the right, y down, z ahead: about z by the yaw, then about its own x by
 * the pitch, of one that looks along -x, in a closed form.
 *
 * @param {SceneCamera} camera
 * @returns {Wxyz}
 */
function wxyzOf(camera) {
  const [yaw, pitch] = [camera.yaw / 2, pitchOf(camera) / 2];
  const [m, n] = [(Math.cos(yaw) - Math.sin(yaw)) / 2, (Math.cos(yaw) + Math.sin(yaw)) / 2];
  const [less, more] = [Math.cos(pitch) - Math.sin(pitch), Math.cos(pitch) + Math.sin(pitch)];
  return [m * less, -m * more, -n * more, n * less];
}

/**
 * A point after steps from another one, in metres along the axes of a camera.
 *
 * @param {SceneCamera} camera
 * @param {Vec3} from
 * @param {Vec3} steps to the right, down and ahead
 * @returns {Vec3}
 */
function stepped(camera, [x, y, z], [right, down, ahead]) {
  const [cos, sin] = [Math.cos(camera.yaw), Math.sin(camera.yaw)];
  const [level, steep] = [Math.cos(pitchOf(camera)), Math.sin(pitchOf(camera))];
  const out = steep * down - level * ahead; // on the ground, away from the focal point
  return [
    x + cos * out - sin * right,
    y + sin * out + cos * right,
    z - level * down - steep * ahead,
  ];
}

/**
 * The sight of a camera in a picture of this size, see `drawSecond`. One without perspective is far above,
 * with a narrow field of view, so that points and texts have their sizes.
 *
 * @param {SceneCamera} camera
 * @param {Vec2} size
 */
export function sightOf(camera, [width, height]) {
  const isFlat = camera.type === "TopDownOrtho";
  const flat = isFlat ? (camera.distance * HALF_VIEW) / NARROW : 0;
  const half = isFlat ? NARROW : HALF_VIEW;
  const across = (half * width) / height;
  return {
    position: stepped(camera, camera.focal_point, [0, 0, -(flat || camera.distance)]),
    wxyz: wxyzOf(camera),
    edges: [-across, across, half, -half],
    far: flat ? 2 * flat : FAR,
    flat,
  };
}

/**
 * @param {SceneCamera} camera
 * @param {Vec2} by pixels
 * @returns {SceneCamera}
 */
export const turned = (camera, [dx, dy]) => ({
  ...camera,
  yaw: camera.yaw - TURN * dx,
  pitch: Math.max(-MAX_PITCH, Math.min(camera.pitch + TURN * dy, MAX_PITCH)),
});

/**
 * Moves what is at the distance of the focal point with the pointer.
 *
 * @param {SceneCamera} camera
 * @param {Vec2} by pixels
 * @param {number} height of the picture
 * @returns {SceneCamera}
 */
export function moved(camera, [dx, dy], height) {
  const meters = (2 * camera.distance * HALF_VIEW) / height;
  const steps = /** @type {Vec3} */ ([-dx * meters, -dy * meters, 0]);
  return { ...camera, focal_point: stepped(camera, camera.focal_point, steps) };
}

/**
 * @param {SceneCamera} camera
 * @param {number} factor of the distance
 * @returns {SceneCamera}
 */
export const zoomed = (camera, factor) => ({
  ...camera,
  distance: Math.max(LEAST, Math.min(camera.distance * factor, MOST)),
});

/**
 * Looks at the ground under a point of the picture; the same above the horizon.
 *
 * @param {SceneCamera} camera
 * @param {Vec2} at pixels
 * @param {Vec2} size
 * @returns {SceneCamera}
 */
export function focused(camera, [x, y], [width, height]) {
  const { position, edges, flat } = sightOf(camera, [width, height]);
  const across = edges[0] + (x / width) * (edges[1] - edges[0]);
  const down = (y / height) * (edges[2] - edges[3]) - edges[2];
  const from = stepped(camera, position, [across * flat, down * flat, 0]);
  const next = stepped(camera, from, flat ? [0, 0, 1] : [across, down, 1]);
  const steps = from[2] / (from[2] - next[2]); // to the ground
  if (!(steps > 0 && steps < MOST)) return camera;
  const focal_point = from.map((at, i) => at + steps * (next[i] - at));
  return { ...camera, focal_point: /** @type {Vec3} */ (focal_point) };
}
