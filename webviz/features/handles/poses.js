// Poses of handles on this page: what it drags is where the drag puts it, whatever the server
// says meanwhile, and controls that face the camera do so in every frame.

import { nodeNamed } from "webviz/scene/picking/things.js";
import { computed, signal } from "webviz/signals.js";
import * as viser from "webviz/viser_page.js";
import * as registry from "webviz/features/handles/registry.js";
import { frameNode } from "webviz/scene/projection.js";
import { about, compose, inverse, rotate, scaled, turnedBy } from "webviz/vectors.js";

/** @import {Moved} from "webviz/features/handles/drags.js" */
/** @import {Pose} from "webviz/vectors.js" */
/** @import {SceneHandle} from "webviz/contents.js" */
/** @import {SceneObject, Vec3, Wxyz} from "webviz/types.js" */

/**
 * `frames` are those that are left after the drag, null while it goes on.
 *
 * @typedef {{control: number, pose: Pose, turned: number, frames: number | null}} Dragged
 */

const FACING = /\|m\d+\.(title|\d+v)$/;
const BEFORE_PLACING = -1000.5; // viser places nodes at -1000
const AFTER_PLACING = -999;
const SETTLE_FRAMES = 3; // for the server's own pose to arrive after a drag
/** @type {Vec3} */
const X = [1, 0, 0];
/** @type {Wxyz} */
const FROM_CAMERA = [0.5, -0.5, 0.5, 0.5]; // from right, up and back to forward, left and up

/** @type {Map<string, Dragged>} */
const dragged = new Map(); // poses by id of the handle
/** @type {Map<string, {object: SceneObject, base: Pose}>} */
const covered = new Map(); // by path of a group, where viser has placed it under a drag

export function install() {
  viser.eachFrame(BEFORE_PLACING, uncover);
  viser.eachFrame(AFTER_PLACING, place);
  const nodeCount = signal(0);
  const facing = computed(() =>
    nodeCount.value ? Object.keys(viser.nodes()).filter(isFacing) : [],
  );
  viser.beforeRender(() => {
    nodeCount.value = Object.keys(viser.nodes()).length;
    face(facing.value);
  });
}

/**
 * The pose of a handle in its frame, `{position, wxyz}`, or null while it is not shown.
 *
 * @param {string} id
 */
export function poseOf(id) {
  const path = registry.nodesOf(id).groups.get("");
  const object = path && viser.node(path);
  const frame = frameNode(registry.all().get(id)?.frame);
  if (!object || !frame) return null;
  return compose(inverted(localOf(frame)), localOf(object));
}

/**
 * Shows a handle at a pose in its frame, with its control turned, until `letGo`.
 *
 * @param {string} id
 * @param {number} control
 * @param {Moved} moved
 */
export function put(id, control, { position, wxyz, turned }) {
  dragged.set(id, { control, pose: { position, wxyz }, turned, frames: null });
  viser.requestRender();
}

/**
 * Shows a handle where the server wants it, once that can be known.
 *
 * @param {string} id
 */
export function letGo(id) {
  const each = dragged.get(id);
  if (each) each.frames = SETTLE_FRAMES;
  viser.requestRender();
}

/** Places what is dragged at once, for what is to be picked before the next frame. */
export function placeNow() {
  uncover();
  place();
  for (const { object } of covered.values()) object.updateMatrixWorld(true);
}

// Before viser places what is new: a pose of the server may equal that of the drag.
function uncover() {
  for (const [path, { object, base }] of covered) {
    object.position.fromArray(base.position);
    if (!isFacing(path)) turn(object, base.wxyz);
  }
  covered.clear();
}

function place() {
  for (const [id, each] of dragged) {
    const handle = registry.all().get(id);
    const mine = handle?.holder === window.webviz.browser;
    if (each.frames !== null && !mine && each.frames-- <= 0) {
      dragged.delete(id);
    } else if (handle) {
      putOver(id, handle, each);
    }
    if (each.frames !== null) viser.requestRender();
  }
}

/**
 * @param {string} id
 * @param {SceneHandle} handle
 * @param {Dragged} dragged
 */
function putOver(id, { frame, controls }, { control, pose, turned }) {
  const node = frameNode(frame);
  if (!node) return;
  const base = localOf(node);
  for (const [suffix, path] of registry.nodesOf(id).groups) {
    const object = viser.node(path);
    if (!object) continue;
    const number = parseInt(suffix, 10);
    const own = controls[number];
    const angle = number === control ? turned : (own?.turned ?? 0);
    const wxyz = own ? about(rotate(own.wxyz, X), angle) : pose.wxyz;
    const whole = compose(base, { position: pose.position, wxyz });
    covered.set(path, { object, base: localOf(object) });
    object.position.fromArray(whole.position);
    if (!isFacing(path)) turn(object, whole.wxyz);
  }
}

/**
 * Turns groups towards the camera: their x axis points away from it, their z axis up.
 *
 * @param {string[]} paths
 */
function face(paths) {
  for (const path of paths) {
    const object = viser.node(path);
    if (!object?.parent) continue;
    const before = localOf(object);
    const camera = object.parent.matrixWorld.clone().invert().multiply(viser.camera().matrixWorld);
    const { w, x, y, z } = object.quaternion.clone().setFromRotationMatrix(camera);
    turn(object, turnedBy(turnedBy([w, x, y, z], FROM_CAMERA), about(X, turnedOf(path))));
    const now = localOf(object);
    object.updateMatrixWorld(true);
    // Texts were placed before this, and follow in the next frame.
    if (!isNearly(before.wxyz, now.wxyz)) viser.requestRender();
  }
}

/**
 * By how much the control of a group that faces the camera has been turned.
 *
 * @param {string} path
 */
function turnedOf(path) {
  const { id, suffix } = registry.groupOf(nodeNamed(`${path}/-`)?.group ?? "") ?? {};
  if (!id) return 0;
  const number = parseInt(suffix ?? "", 10);
  const drag = dragged.get(id);
  if (drag && drag.control === number) return drag.turned;
  return registry.all().get(id)?.controls[number]?.turned ?? 0;
}

/** @param {string} path */
function isFacing(path) {
  if (path.split("/").length !== 3) return false;
  const node = nodeNamed(`${path}/-`);
  return node !== null && FACING.test(node.group);
}

/**
 * @param {SceneObject} object
 * @returns {Pose}
 */
const localOf = ({ position, quaternion: { w, x, y, z } }) => ({
  position: position.toArray(),
  wxyz: [w, x, y, z],
});
/**
 * @param {SceneObject} object
 * @param {Wxyz} wxyz
 */
const turn = (object, [w, x, y, z]) => object.quaternion.set(x, y, z, w);
/**
 * @param {Pose} pose
 * @returns {Pose}
 */
const inverted = ({ position, wxyz }) => {
  const back = inverse(wxyz);
  return {
    position: rotate(back, scaled(position, -1)),
    wxyz: back,
  };
};
/**
 * @param {Wxyz} a
 * @param {Wxyz} b
 */
const isNearly = (a, b) => Math.abs(a.reduce((sum, value, i) => sum + value * b[i], 0)) > 1 - 1e-9;
