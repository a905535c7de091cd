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
import { signal } from "webviz/signals.js";
import * as viser from "webviz/viser_page.js";

/** @import {PlaceCamera, StartView} from "webviz/messages.js" */
/** @import {Matrix4, PerspectiveCamera, Raycaster, Vector3} from "three" */
/** @import {SceneObject, Vec3} from "webviz/types.js" */

const { RAISED, EYE, FIELD_OF_VIEW, FLAT_FIELD_OF_VIEW } = constants;
const SENT_MS = 100; // after which viser has reported the camera

/** @type {(() => void)[]} */
const listeners = [];
const currentView = signal(/** @type {PlaceCamera | StartView | null} */ (null));
/** The transform before the camera's own pose, null for a view that follows nothing. */
const rig = signal(/** @type {Matrix4 | null} */ (null));
/** The height of the canvas that the view is shown for. */
const height = signal(0);
/** The focal point of a view that looks at another one, and the point that the camera was aimed at. */
const focus = signal(/** @type {{focal: Vector3, aimed: Vector3} | null} */ (null));

/** The type of the view, "" before there is one. */
export const type = () => currentView.value?.view ?? "";
/** True for views that look around from a position, without a focal point. */
export const isFPS = () => type() === "FPS" || type() === "FrameAligned";
/** The target frame of the view. */
export const targetFrame = () => options().target_frame ?? "";
/**
 * The options of the view, which stay when its camera moves.
 *
 * @returns {Record<string, any>}
 */
export const options = () => currentView.value?.options ?? {};
/** The transform before the camera's own pose. */
export const followed = () => rig.value ?? matrix();
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
  const toCamera = viser.camera().matrixWorldInverse.clone().multiply(toThree());
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
  (2 * viser.controls().distance * Math.tan((viser.camera().fov * Math.PI) / 360)) /
  viser.canvas().clientHeight;
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
const vector = (xyz) => viser.camera().position.clone().fromArray(xyz);
/** @returns {Matrix4} */
const matrix = () => viser.camera().matrixWorld.clone().identity();
const isFlat = () => type() === "TopDownOrtho";

// Follow the target frame: its position, with its rotation or yaw for a view that turns with it;
// and upside down for one whose z axis is inverted.
function follow() {
  const view = currentView.value;
  const node = view?.frame && viser.node(view.frame);
  const isInverted = options().invert_z_axis;
  if (view === null || (view.frame ? !node : !isInverted)) return;
  const up = toThree();
  const down = up.clone().invert();
  const next = matrix();
  if (node) {
    const pose = down.clone().multiply(node.matrixWorld);
    const m = pose.elements;
    if (view.view === "FrameAligned") next.extractRotation(pose);
    if (view.view === "ThirdPersonFollower") next.makeRotationZ(Math.atan2(m[1], m[0]));
    next.setPosition(m[12], m[13], m[14]);
  }
  if (isInverted) next.multiply(matrix().makeRotationX(Math.PI));
  rig.value = next.premultiply(up).multiply(down);
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
    if (rig.value === null) return;
    this.matrixWorld.premultiply(rig.value);
    this.matrixWorldInverse.copy(this.matrixWorld).invert();
  };
}

// Adjust what viser keeps before the camera, and the cross where it turns about, without knowing rigs.
/**
 * @param {PerspectiveCamera} camera
 * @param {SceneObject | undefined} cross
 */
function adjust(camera, cross) {
  if (cross) cross.visible = rig.value === null;
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
const isRaised = () => ["XYOrbit", "ThirdPersonFollower"].includes(type());
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
  if (!isRaised() || focus.value === null) return;
  const { focal, aimed } = focus.value;
  const controls = viser.controls();
  const target = controls.getTarget(vector([0, 0, 0]));
  focal.add(target).sub(aimed).setY(0);
  const goal = focal.clone().add(raise());
  const isThere = target.distanceTo(goal) < 1e-9 * (1 + goal.length());
  if (!isThere) controls.moveTo(goal.x, goal.y, goal.z, false);
  focus.value = { focal, aimed: isThere ? target : goal };
}

function report() {
  const view = currentView.value;
  if (view === null) return;
  channel.send({
    type: "ViewReport",
    number: view.number,
    view: view.view,
    options: view.options,
    width: viser.canvas().clientWidth,
    height: viser.canvas().clientHeight,
  });
}

/** @param {PlaceCamera | StartView} view */
function show(view) {
  if (currentView.value?.frame !== view.frame || !view.frame) rig.value = null;
  currentView.value = view;
  follow();
  height.value = viser.canvas().clientHeight;
  const camera = viser.camera();
  const controls = viser.controls();
  const up = toThree();
  const target = vector(/** @type {Vec3} */ (view.look_at));
  const offset = vector(/** @type {Vec3} */ (view.position)).sub(target);
  const fov = isFlat() ? FLAT_FIELD_OF_VIEW : FIELD_OF_VIEW;
  if (isFlat()) offset.setLength(height.value / Number(view.scale) / 2 / Math.tan(fov / 2));
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
  const aimed = controls.getTarget(vector([0, 0, 0]));
  focus.value = isRaised() ? { focal: aimed.clone().sub(raise()), aimed } : null;
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
  const view = currentView.value;
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
    scale: isFlat() ? height.value / wide : null,
  };
}

/**
 * @param {StartView} start
 * @param {StartView | null} before what this page showed before it was loaded again
 */
function join(start, before) {
  viser.reveal(); // also of a scene without a page around it
  if (currentView.value === null) return show({ ...start, ...before, number: start.number });
  // A lost connection is back: the camera has not moved, but the server does not know it.
  viser.sendCamera();
  setTimeout(report, SENT_MS);
}

/** The cross where the camera turns about, which viser shows. */
const findCross = () =>
  viser.scene().children.find((child) => {
    let isCross = false;
    child.traverse((part) => (isCross ||= part.geometry?.parameters?.width === 0.4));
    return isCross;
  });

/** Keeps a view without perspective as large as it is when the canvas changes its height. */
function resize() {
  const [tall, before] = [viser.canvas().clientHeight, height.value];
  if (currentView.value === null || tall === 0 || tall === before) return;
  if (isFlat()) viser.controls().dollyTo((viser.controls().distance * tall) / before, false);
  height.value = tall;
  setTimeout(report, SENT_MS);
}

export function install() {
  height.value = viser.canvas().clientHeight;
  const before = surviveReload("view", placement);
  const cross = findCross();

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
  viser.eachFrame(-900, () => rig.value !== null && viser.scene().updateMatrixWorld());

  viser.beforeRender((gl, scene, camera) => {
    adopt(camera);
    if (isFlat()) flatten(camera);
    follow();
    camera.updateMatrixWorld();
    adjust(camera, cross);
    settle();
  });

  new ResizeObserver(resize).observe(viser.canvas());
  channel.on("PlaceCamera", show);
  channel.on("StartView", (start) => join(start, before));
}
