// Views, as RViz has them, and their cameras; `webviz/api/views/` explains the numbers.
//
// A camera is `[position, lookAt]` in the coordinates of a target frame, whose z points up.

import constants from "webviz/constants.js";
import { add, inverse, norm, rotate, scaled, sub } from "webviz/vectors.js";

/** @import {Vec3} from "webviz/types.js" */
/** @import {View, ViewCamera, ViewRig} from "webviz/recorded/types.js" */

const { RAISED, EYE, FIELD_OF_VIEW, FLAT_FIELD_OF_VIEW } = constants;
const STEEPEST = 1.5698;
const TILT = 1e-5;
const NEAREST = 1e-3;
const REACH = 10;
const FARTHEST = 1000;
const MARGIN = 1.15;
const SMALLEST = 0.05;
const HALF = Math.PI / 2;
const AXIS_M = 5;

/** @param {number} yaw @param {number} pitch @returns {Vec3} */
const direction = (yaw, pitch) => [
  Math.cos(yaw) * Math.cos(pitch),
  Math.sin(yaw) * Math.cos(pitch),
  Math.sin(pitch),
];
/** @param {number} yaw @param {number} pitch */
const up = (yaw, pitch) => direction(yaw, pitch + HALF);
/** @param {number} angle */
const wrapped = (angle) => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
/** @param {number} value @param {number} low @param {number} high */
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

/** @type {Record<string, Partial<View>>} */
const DEFAULTS = {
  FPS: { yaw: 0, pitch: 0, position: [5, 5, 10] },
  FrameAligned: {
    yaw: 0,
    pitch: 0,
    position: [-AXIS_M, 0, 0],
    point_towards: "+x axis",
    lock_camera: false,
    invert_z_axis: false,
  },
  TopDownOrtho: { scale: 10, angle: 0, x: 0, y: 0 },
};
const AROUND = {
  distance: 10,
  yaw: 0.785398,
  pitch: 0.785398,
  focal_point: [0, 0, 0],
  invert_z_axis: false,
};
const OPTIONS = ["target_frame", "invert_z_axis", "point_towards", "lock_camera"];

/**
 * The fields of a view that moving its camera leaves, as far as a type has them.
 *
 * @param {string} type
 * @param {View} view
 * @returns {Record<string, string | boolean>}
 */
export const optionsOf = (type, view) => {
  const own = ["target_frame", ...Object.keys(DEFAULTS[type] ?? AROUND)];
  const entries = Object.entries(view).filter(
    ([key]) => OPTIONS.includes(key) && own.includes(key),
  );
  return Object.fromEntries(entries);
};

/**
 * The initial view of a type, with the options of another view.
 *
 * @param {string} type
 * @param {View} view
 * @returns {View}
 */
export const like = (type, view) =>
  /** @type {View} */ ({ ...(DEFAULTS[type] ?? AROUND), ...optionsOf(type, view), type });

/** @param {View} view @param {Vec3} xyz @returns {Vec3} */
const flipped = ({ invert_z_axis }, [x, y, z]) => (invert_z_axis ? [x, -y, -z] : [x, y, z]);
/** @param {string} type */
const isFPS = (type) => type === "FPS" || type === "FrameAligned";

/**
 * The initial view of the type of a view, with its options.
 *
 * @param {View} view
 * @returns {View}
 */
export function zeroView(view) {
  const blank = like(view.type, view);
  const [sign, name] = blank.point_towards ?? "";
  if (!"xyz".includes(name ?? "none")) return blank;
  const unit = [..."xyz"].map((each) => (each !== name ? 0 : sign === "-" ? -1 : 1));
  const axis = flipped(blank, /** @type {Vec3} */ (unit));
  return viewOf(blank, [scaled(axis, -AXIS_M), scaled(axis, EYE - AXIS_M)], 1);
}

/**
 * @param {View} view
 * @param {number} height of the picture in pixels
 * @returns {ViewCamera}
 */
export function cameraOf(view, height) {
  const { yaw = 0, pitch = 0 } = view;
  if (isFPS(view.type)) {
    const position = view.position ?? [0, 0, 0];
    return [position, sub(position, scaled(direction(yaw + Math.PI, pitch), EYE))];
  }
  if (view.type === "TopDownOrtho") {
    /** @type {Vec3} */
    const at = [view.x ?? 0, view.y ?? 0, 0];
    const distance = height / (view.scale ?? 10) / 2 / Math.tan(FLAT_FIELD_OF_VIEW / 2);
    const away = direction((view.angle ?? 0) - HALF, HALF - TILT);
    return [add(at, scaled(away, distance)), at];
  }
  const distance = view.distance ?? 10;
  const raised = view.type === "Orbit" ? 0 : RAISED * distance;
  const focal = flipped(view, view.focal_point ?? [0, 0, 0]);
  const at = add(focal, scaled(up(yaw, pitch), raised));
  return [add(at, scaled(direction(yaw, pitch), distance)), at];
}

/**
 * A view as a camera shows it now.
 *
 * @param {View} view has the type and the options
 * @param {ViewCamera} camera
 * @param {number} height
 * @returns {View}
 */
export function viewOf(view, [position, lookAt], height) {
  const offset = sub(position, lookAt);
  const distance = Math.max(norm(offset), 1e-9);
  const yaw = Math.atan2(offset[1], offset[0]);
  const slope = Math.asin(clamp(offset[2] / distance, -1, 1));
  const pitch = clamp(slope, -STEEPEST, STEEPEST);
  if (isFPS(view.type)) return { ...view, yaw: wrapped(yaw + Math.PI), pitch, position };
  if (view.type === "TopDownOrtho") {
    const scale = height / 2 / Math.tan(FLAT_FIELD_OF_VIEW / 2) / distance;
    const angle = wrapped(yaw + HALF);
    return { ...view, scale: clamp(scale, 1e-5, 1e6), angle, x: lookAt[0], y: lookAt[1] };
  }
  const raised = view.type === "Orbit" ? 0 : RAISED * distance;
  const focal_point = flipped(view, sub(lookAt, scaled(up(yaw, pitch), raised)));
  return { ...view, distance, yaw, pitch, focal_point };
}

/** @param {ViewRig} rig @param {ViewCamera} camera @returns {ViewCamera} */
const outward = ({ origin, wxyz }, [a, b]) => [
  add(rotate(wxyz, a), origin),
  add(rotate(wxyz, b), origin),
];
/** @param {ViewRig} rig @param {ViewCamera} camera @returns {ViewCamera} */
const inward = ({ origin, wxyz }, [a, b]) => [
  rotate(inverse(wxyz), sub(a, origin)),
  rotate(inverse(wxyz), sub(b, origin)),
];

/**
 * A perspective camera that shows nearly the same as a view and looks at its focal point.
 *
 * @param {View} view
 * @param {number} height
 * @returns {ViewCamera}
 */
function eyeOf(view, height) {
  const [position, lookAt] = cameraOf(view, height);
  const offset = sub(position, lookAt);
  const length = norm(offset);
  if (view.type === "TopDownOrtho") {
    const flatter = Math.tan(FLAT_FIELD_OF_VIEW / 2) / Math.tan(FIELD_OF_VIEW / 2);
    const back = direction((view.angle ?? 0) - HALF, STEEPEST);
    return [add(lookAt, scaled(back, length * flatter)), lookAt];
  }
  if (isFPS(view.type)) {
    const forward = scaled(offset, -1 / length);
    const reach = Math.abs(forward[2]) > 1e-3 ? -position[2] / forward[2] : -1;
    return [
      position,
      add(position, scaled(forward, reach > 0 && reach < FARTHEST ? reach : REACH)),
    ];
  }
  return [position, lookAt];
}

/**
 * The view of the same type and options that shows the same as a perspective camera.
 *
 * @param {View} view
 * @param {ViewCamera} eye
 * @param {number} height
 */
function fitted(view, [position, lookAt], height) {
  const offset = sub(position, lookAt);
  const distance = norm(offset);
  const back = scaled(offset, 1 / distance);
  const level = Math.hypot(back[0], back[1]);
  if (view.type === "TopDownOrtho") {
    const yaw = level > 1e-6 ? Math.atan2(back[1], back[0]) : -HALF;
    const scale = height / 2 / Math.tan(FIELD_OF_VIEW / 2) / distance;
    const [x, y] = lookAt;
    return { ...view, scale: clamp(scale, 1e-5, 1e6), angle: wrapped(yaw + HALF), x, y };
  }
  const raised = RAISED * level;
  if (!isFPS(view.type) && view.type !== "Orbit" && back[2] > 0.05 - raised) {
    // Along the line of projection to where the focal point lies on the ground.
    const step = (lookAt[2] - raised * distance) / (back[2] + raised);
    if (NEAREST * distance < distance + step && distance + step < FARTHEST)
      return viewOf(view, [position, sub(lookAt, scaled(back, step))], height);
  }
  return viewOf(view, [position, lookAt], height);
}

/**
 * A view of another type or target frame that shows nearly the same.
 *
 * @param {View} view
 * @param {ViewRig} rig of its target frame
 * @param {View} other has the new type, target frame and options
 * @param {ViewRig} newRig
 * @param {number} height
 * @returns {View}
 */
export function mimic(view, rig, other, newRig, height) {
  if (view.type === other.type)
    return viewOf(other, inward(newRig, outward(rig, cameraOf(view, height))), height);
  return fitted(other, inward(newRig, outward(rig, eyeOf(view, height))), height);
}

/**
 * The view from the same direction that fits a box of the fixed frame.
 *
 * @param {View} view
 * @param {ViewRig} rig
 * @param {{low: Vec3, high: Vec3}} box
 * @param {{width: number, height: number}} size of the picture
 * @returns {View}
 */
export function focus(view, rig, { low, high }, { width, height }) {
  const radius = Math.max(norm(sub(high, low)) / 2, SMALLEST);
  const narrow = Math.atan(Math.tan(FIELD_OF_VIEW / 2) * Math.min(1, width / height));
  const [position, lookAt] = outward(rig, eyeOf(view, height));
  const offset = sub(position, lookAt);
  const at = scaled(add(low, high), 0.5);
  const distance = (MARGIN * radius) / Math.sin(narrow);
  const eye = add(at, scaled(offset, distance / norm(offset)));
  return fitted(view, inward(rig, [eye, at]), height);
}
