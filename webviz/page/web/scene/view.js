// The view of the page: where its camera is, and what it follows.
//
// A view follows its target frame by a pose that is put before the camera's own when a frame is
// drawn, read from the node of that frame at that very moment: robot and camera move in the same
// picture, and turning the camera meanwhile turns it relative to the frame. TopDownOrtho is
// viser's camera far above with a narrow field of view, so that all that asks for these two
// (dragging, sizes of points and labels) stays right, and the projection of the picture and of rays
// is replaced by a parallel one.

import * as channel from "webviz/channel.js";
import constants from "webviz/constants.js";
import { toThree } from "webviz/scene/fixed_frame.js";
import { surviveReload } from "webviz/remember.js";
import * as viser from "webviz/viser_page.js";

/** @import {PlaceCamera, StartView} from "webviz/messages.js" */
/** @import {Matrix4, PerspectiveCamera, Raycaster, Vector3} from "three" */
/** @import {SceneObject, Vec3} from "webviz/types.js" */

const { RAISED, EYE, FIELD_OF_VIEW, FLAT_FIELD_OF_VIEW } = constants;
const SENT_MS = 100; // after which viser has reported the camera

/** @type {(() => void)[]} */
const listeners = [];
/** @type {PerspectiveCamera} */
let camera;
/** @type {HTMLCanvasElement} */
let canvas;
/** @type {SceneObject | undefined} */
let cross;
/** @type {PlaceCamera | StartView | null} */
let view = null;
/** @type {StartView | null} */
let before = null; // the page was loaded again
/** @type {Matrix4 | null} */
let rig = null;
let height = 0;
/** @type {Vector3 | null} */
let focal = null;
/** @type {Vector3} */
let aimed;

/** The type of the view, "" before there is one. */
export const type = () => (view === null ? "" : view.view);
/** True for views that look around from a position, without a focal point. */
export const isFPS = () => type() === "FPS" || type() === "FrameAligned";
/** The target frame of the view. */
export const targetFrame = () => options().target_frame ?? "";
/**
 * The options of the view, which stay when its camera moves.
 *
 * @returns {Record<string, any>}
 */
export const options = () => view?.options ?? {};
/** The transform before the camera's own pose. */
export const followed = () => (rig === null ? matrix() : rig);
/** The offset of the point that the camera looks at from the focal point of the view. */
export const raised = () => (isRaised() ? raise() : vector([0, 0, 0]));
/**
 * Turns the camera about what it looks at, to where a direction of the fixed frame points.
 *
 * @param {Vec3} xyz
 */
export function lookFrom(xyz) {
  const direction = vector(xyz).transformDirection(toThree());
  direction.transformDirection(followed().clone().invert());
  const controls = viser.controls();
  const polar = Math.acos(Math.min(Math.max(direction.y, -1), 1));
  const isSteep = Math.abs(direction.y) > 0.999;
  const azimuth = isSteep ? controls.azimuthAngle : Math.atan2(direction.x, direction.z);
  controls.normalizeRotations();
  controls.rotateTo(azimuth, polar, true);
}
/**
 * The axes of the fixed frame as the camera sees them: right, up, and towards it.
 *
 * @returns {Vec3[]}
 */
export function axes() {
  const toCamera = camera.matrixWorldInverse.clone().multiply(toThree());
  /** @type {Vec3[]} */
  const units = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
  return units.map((axis) => vector(axis).transformDirection(toCamera).toArray());
}
/** The size of a pixel where the camera looks at, in metres. */
export const metersPerPixel = () =>
  (2 * viser.controls().distance * Math.tan((camera.fov * Math.PI) / 360)) / canvas.clientHeight;
/**
 * Calls `listener` whenever another view is shown.
 *
 * @param {() => unknown} listener
 */
export const onShow = (listener) => listeners.push(listener);

/**
 * @param {Vec3} xyz
 * @returns {Vector3}
 */
const vector = (xyz) => camera.position.clone().fromArray(xyz);
/** @returns {Matrix4} */
const matrix = () => camera.matrixWorld.clone().identity();
const isFlat = () => view !== null && view.view === "TopDownOrtho";

// Follow the target frame: its position, with its rotation or yaw for a view that turns with it;
// and upside down for one whose z axis is inverted.
function follow() {
  const node = view?.frame && viser.node(view.frame);
  const isInverted = options().invert_z_axis;
  if (view === null || (view.frame ? !node : !isInverted)) return;
  const up = toThree();
  const down = up.clone().invert();
  rig = matrix();
  if (node) {
    const pose = down.clone().multiply(node.matrixWorld);
    const m = pose.elements;
    if (view.view === "FrameAligned") rig.extractRotation(pose);
    if (view.view === "ThirdPersonFollower") rig.makeRotationZ(Math.atan2(m[1], m[0]));
    rig.setPosition(m[12], m[13], m[14]);
  }
  if (isInverted) rig.multiply(matrix().makeRotationX(Math.PI));
  rig.premultiply(up).multiply(down);
}

// A parallel projection as large as the camera's own is where it looks at.
/** @param {PerspectiveCamera} camera */
function flatten(camera) {
  const distance = viser.controls().distance;
  const top = distance * Math.tan((camera.fov * Math.PI) / 360);
  const right = top * camera.aspect;
  camera.projectionMatrix.makeOrthographic(
    -right,
    right,
    top,
    -top,
    distance / 100,
    distance * 2,
    camera.coordinateSystem,
    camera.reversedDepth,
  );
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
}

/** @param {PerspectiveCamera & {webviz?: boolean}} camera */
function adopt(camera) {
  if (camera.webviz) return;
  camera.webviz = true;
  const { updateProjectionMatrix, updateMatrixWorld } = camera;
  camera.updateProjectionMatrix = function () {
    updateProjectionMatrix.call(this);
    if (isFlat()) flatten(this);
  };
  camera.updateMatrixWorld = function (/** @type {boolean} */ force) {
    updateMatrixWorld.call(this, force);
    if (rig === null) return;
    this.matrixWorld.premultiply(rig);
    this.matrixWorldInverse.copy(this.matrixWorld).invert();
  };
}

// Adjust what viser keeps before the camera, and the cross where it turns about, without knowing rigs.
/** @param {PerspectiveCamera} camera */
function adjust(camera) {
  if (cross) cross.visible = rig === null;
  for (const child of viser.scene().children) {
    if (child.material && child.material === viser.backgroundMaterial()) {
      const depth = isFlat() ? viser.controls().distance : 1;
      const tall = 2 * depth * Math.tan((camera.fov * Math.PI) / 360);
      const scale = matrix()
        .makeScale(tall * camera.aspect, tall, 1)
        .setPosition(0, 0, -depth);
      child.matrixWorld.multiplyMatrices(camera.matrixWorld, scale);
    }
  }
}

// XYOrbit looks at a point that is as far from its focal point, along the camera's own up, as the
// camera is far away. Turning and zooming leave the focal point, moving moves it on the ground.
const isRaised = () =>
  view !== null && (view.view === "XYOrbit" || view.view === "ThirdPersonFollower");
function raise() {
  const { azimuthAngle, polarAngle, distance } = viser.controls();
  const back = -Math.cos(polarAngle);
  return vector([
    back * Math.sin(azimuthAngle),
    Math.sin(polarAngle),
    back * Math.cos(azimuthAngle),
  ]).multiplyScalar(RAISED * distance);
}
function settle() {
  if (!isRaised() || focal === null) return;
  const controls = viser.controls();
  const target = controls.getTarget(vector([0, 0, 0]));
  focal.add(target).sub(aimed).setY(0);
  const wanted = focal.clone().add(raise());
  aimed = target;
  if (target.distanceTo(wanted) < 1e-9 * (1 + wanted.length())) return;
  controls.moveTo(wanted.x, wanted.y, wanted.z, false);
  aimed = wanted;
}

function report() {
  if (view === null) return;
  channel.send({
    type: "ViewReport",
    number: view.number,
    view: view.view,
    options: view.options,
    width: canvas.clientWidth,
    height: canvas.clientHeight,
  });
}

/** @param {PlaceCamera | StartView} wanted */
function show(wanted) {
  if (view?.frame !== wanted.frame || !wanted.frame) rig = null;
  view = wanted;
  follow();
  height = canvas.clientHeight;
  const controls = viser.controls();
  const up = toThree();
  const target = vector(/** @type {Vec3} */ (wanted.look_at));
  const offset = vector(/** @type {Vec3} */ (wanted.position)).sub(target);
  const fov = isFlat() ? FLAT_FIELD_OF_VIEW : FIELD_OF_VIEW;
  if (isFlat()) offset.setLength(height / Number(wanted.scale) / 2 / Math.tan(fov / 2));
  const position = target.clone().add(offset).applyMatrix4(up);
  target.applyMatrix4(up);
  controls.minDistance = isFPS() ? EYE : 0.01;
  controls.maxDistance = Infinity;
  viser.setMaxOrbitDistance(1e7);
  controls.minPolarAngle = 0;
  controls.maxPolarAngle = Math.PI;
  camera.fov = (fov * 180) / Math.PI;
  adopt(camera);
  controls.setLookAt(...position.toArray(), ...target.toArray(), false);
  controls.update(0);
  aimed = controls.getTarget(vector([0, 0, 0]));
  focal = isRaised() ? aimed.clone().sub(raise()) : null;
  if (isFlat()) controls.minPolarAngle = controls.maxPolarAngle = controls.polarAngle;
  camera.updateProjectionMatrix();
  for (const listener of listeners) listener();
  viser.sendCamera();
  viser.requestRender();
  setTimeout(report, SENT_MS);
}

/**
 * The view with its camera where it is now.
 *
 * @returns {StartView | null}
 */
function placement() {
  if (view === null) return null;
  const down = toThree().clone().invert();
  const controls = viser.controls();
  const wide = 2 * controls.distance * Math.tan(FLAT_FIELD_OF_VIEW / 2);
  return {
    ...view,
    type: "StartView",
    position: controls
      .getPosition(vector([0, 0, 0]))
      .applyMatrix4(down)
      .toArray(),
    look_at: controls
      .getTarget(vector([0, 0, 0]))
      .applyMatrix4(down)
      .toArray(),
    scale: isFlat() ? height / wide : null,
  };
}

/** @param {StartView} start */
function join(start) {
  viser.reveal(); // also of a scene without a page around it
  if (view === null) return show({ ...start, ...before, number: start.number });
  // A lost connection is back: the camera has not moved, but the server does not know it.
  viser.sendCamera();
  setTimeout(report, SENT_MS);
}

export function install() {
  camera = viser.camera();
  canvas = viser.canvas();
  height = canvas.clientHeight;
  before = surviveReload("view", placement);
  cross = viser.scene().children.find((child) => {
    let found = false;
    child.traverse((part) => (found ||= part.geometry?.parameters?.width === 0.4));
    return found;
  });

  const rays = viser.Raycaster().prototype;
  const fromCamera = rays.setFromCamera;
  /** @type {(this: Raycaster, ...args: Parameters<Raycaster["setFromCamera"]>) => void} */
  rays.setFromCamera = function (point, camera) {
    fromCamera.call(this, point, camera);
    if (!isFlat() || !("webviz" in camera)) return;
    const near = camera.reversedDepth ? 1 : -1;
    this.ray.origin.set(point.x, point.y, near).unproject(camera);
    this.ray.direction.set(0, 0, -1).transformDirection(camera.matrixWorld);
  };

  // Labels stand where their parents were in the frame before, unless that is brought up to date
  // between viser's placing of nodes and of labels.
  viser.eachFrame(-900, () => rig !== null && viser.scene().updateMatrixWorld());

  viser.beforeRender((gl, scene, camera) => {
    adopt(camera);
    if (isFlat()) flatten(camera);
    follow();
    camera.updateMatrixWorld();
    adjust(camera);
    settle();
  });

  new ResizeObserver(() => {
    const tall = canvas.clientHeight;
    if (view === null || tall === 0 || tall === height) return;
    if (isFlat()) viser.controls().dollyTo((viser.controls().distance * tall) / height, false);
    height = tall;
    setTimeout(report, SENT_MS);
  }).observe(canvas);

  channel.on("PlaceCamera", show);
  channel.on("StartView", join);
}
