// Large clouds at rest, of which as many points are drawn as the page holds: fewer of a block that is
// far away, none of one out of sight. The first points of a block stand for all of it.

import constants from "webviz/constants.js";
import * as capacity from "webviz/scene/capacity.js";
import * as viser from "webviz/viser_page.js";

/** @import {Matrix4, PerspectiveCamera} from "three" */
/** @import {SceneObject} from "webviz/types.js" */

const MARK = `/${constants.BLOCK_PREFIX}`;
const LEAST_SHARE = 0.5; // of the points held, although other clouds have more

/** @type {WeakMap<object, {middle: number[], radius: number}>} */
const spheres = new WeakMap(); // by array of coordinates

export function install() {
  let others = 0;
  let thinned = 0;
  viser.beforeEveryRender((gl, scene, camera) => {
    const limit = capacity.points();
    thinned = thin(blocks(), camera, Math.max(limit - others, LEAST_SHARE * limit));
  });
  // three.js may find blocks out of sight that were counted.
  viser.afterRender(() => (others = Math.max(viser.gl().info.render.points - thinned, 0)));
}

/** @returns {SceneObject[]} */
function blocks() {
  /** @type {SceneObject[]} */
  const clouds = [];
  const nodes = viser.nodes();
  for (const name in nodes) {
    if (!name.includes(MARK) || !nodes[name] || !isShown(nodes[name])) continue;
    nodes[name].traverse((object) => object.isPoints && clouds.push(object));
  }
  return clouds;
}

/**
 * @param {SceneObject} object
 * @returns {boolean}
 */
function isShown(object) {
  for (let each = /** @type {SceneObject | null} */ (object); each; each = each.parent)
    if (!each.visible) return false;
  return true;
}

// All points up to some distance, and fewer by its square beyond.
/**
 * @param {SceneObject[]} objects
 * @param {PerspectiveCamera} camera
 * @param {number} budget
 */
function thin(objects, camera, budget) {
  const candidates = [];
  for (const object of objects) {
    object.visible = false;
    const xyz = object.geometry.attributes.position?.array;
    if (!xyz?.length) continue;
    const weight = weightOf(sphereOf(xyz), object.matrixWorld, camera) * xyz.length;
    if (weight) candidates.push({ object, count: xyz.length / 3, weight });
  }
  candidates.sort((a, b) => a.count / a.weight - b.count / b.weight);
  let weights = candidates.reduce((sum, { weight }) => sum + weight, 0);
  let total = 0;
  for (const { object, count, weight } of candidates) {
    const quota = Math.min(count, Math.floor(((budget - total) * weight) / weights));
    object.visible = quota > 0;
    object.geometry.setDrawRange(0, quota);
    weights -= weight;
    total += quota;
  }
  return total;
}

// The weight of a sphere, the more the nearer; 0 out of sight.
/**
 * @param {{middle: number[], radius: number}} sphere
 * @param {Matrix4} matrixWorld
 * @param {PerspectiveCamera} camera
 * @returns {number}
 */
function weightOf({ middle, radius }, matrixWorld, camera) {
  const at = camera.position.clone().fromArray(middle);
  at.applyMatrix4(matrixWorld).applyMatrix4(camera.matrixWorldInverse);
  const p = camera.projectionMatrix.elements;
  for (const axis of [0, 1]) {
    for (const side of [-1, 1]) {
      const [x, y, z, w] = [0, 1, 2, 3].map((i) => p[4 * i + 3] + side * p[4 * i + axis]);
      if (x * at.x + y * at.y + z * at.z + w < -radius * Math.hypot(x, y, z)) return 0;
    }
  }
  const isFlat = p[11] === 0; // without perspective
  return isFlat ? 1 : 1 / Math.max(at.length(), radius, 1e-6) ** 2;
}

/**
 * @param {Float32Array} xyz
 * @returns {{middle: number[], radius: number}}
 */
function sphereOf(xyz) {
  const entry = spheres.get(xyz);
  if (entry) return entry;
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < xyz.length; i += 3) {
    for (let axis = 0; axis < 3; axis++) {
      const value = xyz[i + axis];
      if (value < low[axis]) low[axis] = value;
      if (value > high[axis]) high[axis] = value;
    }
  }
  const middle = low.map((value, axis) => (value + high[axis]) / 2);
  const sphere = { middle, radius: Math.hypot(...middle.map((value, axis) => high[axis] - value)) };
  spheres.set(xyz, sphere);
  return sphere;
}
