// Projection of a frame by the camera.

import constants from "webviz/constants.js";
import { casterAt } from "webviz/scene/rays.js";
import * as viser from "webviz/viser_page.js";

/** @import {Camera, Vector3} from "three" */
/** @import {Ray} from "webviz/vectors.js" */
/** @import {SceneObject, Vec2, Vec3} from "webviz/types.js" */

/** @typedef {ReturnType<typeof projectionOf>} Projection */

const { ROOT } = constants;

/**
 * The name of viser's node of a group of the scene.
 *
 * @param {string} group
 */
export const pathOf = (group) => `${ROOT}/${segment(group)}`;

/** @param {string} text */
const segment = (text) =>
  encodeURIComponent(text)
    .replace(/[!'()*]/g, (letter) => `%${letter.charCodeAt(0).toString(16).toUpperCase()}`)
    .replaceAll("%20", " ") || "%";

/**
 * The object whose coordinates are those of a frame, given its group, "" for the fixed frame.
 *
 * @param {string | undefined} group
 */
export const frameNode = (group) => viser.node(group ? pathOf(group) : ROOT);

/**
 * Projection of the coordinates of an object: `rayAt(xy)` through a point of the window,
 * `project(point)` to one, or null behind the camera; `right`, `up` and `forward`; `perPixel(point)`
 * and `unit(point)`, how many metres a pixel is there, and a hundred.
 *
 * @param {SceneObject} object
 */
export function projectionOf(object) {
  object.updateWorldMatrix(true, false);
  const camera = viser.camera();
  const back = object.matrixWorld.clone().invert();
  /** @param {Vec3} xyz */
  const worldPlace = (xyz) =>
    camera.position.clone().fromArray(xyz).applyMatrix4(object.matrixWorld);
  /** @param {Vec3} point */
  const perPixel = (point) => pixelSize(camera, worldPlace(point));
  /**
   * @param {number} column
   * @param {number} sign
   * @returns {Vec3}
   */
  const direction = (column, sign) =>
    camera.position
      .clone()
      .fromArray(camera.matrixWorld.elements, 4 * column)
      .multiplyScalar(sign)
      .transformDirection(back)
      .toArray();
  return {
    /**
     * @param {Vec2} xy
     * @returns {Ray}
     */
    rayAt(xy) {
      const { origin, direction } = casterAt(xy).ray.applyMatrix4(back);
      return { origin: origin.toArray(), direction: direction.toArray() };
    },
    /** @param {Vec3} point */
    project: (point) => windowPlace(camera, worldPlace(point)),
    perPixel,
    /** @param {Vec3} point */
    unit: (point) => 100 * perPixel(point),
    right: direction(0, 1),
    up: direction(1, 1),
    forward: direction(2, -1),
    /**
     * @param {Vector3} point
     * @returns {Vec3}
     */
    toFrame: (point) => point.clone().applyMatrix4(back).toArray(),
  };
}

/**
 * The point of the window where the camera sees a point of the world, null behind it.
 *
 * @param {Camera} camera
 * @param {Vector3} place
 * @returns {Vec2 | null}
 */
function windowPlace(camera, place) {
  if (place.clone().applyMatrix4(camera.matrixWorldInverse).z >= 0) return null;
  const { x, y } = place.clone().project(camera);
  const { left, top, width, height } = viser.canvas().getBoundingClientRect();
  return [left + ((x + 1) / 2) * width, top + ((1 - y) / 2) * height];
}

/**
 * Metres of a pixel at a point of the world.
 *
 * @param {Camera} camera
 * @param {Vector3} place
 * @returns {number}
 */
function pixelSize(camera, place) {
  const depth = place.clone().applyMatrix4(camera.matrixWorldInverse);
  const { elements } = camera.projectionMatrix;
  // The projection divides by w, which is the depth, or 1 without perspective.
  const w = elements[11] * depth.z + elements[15];
  return (2 * w) / (elements[5] * viser.canvas().clientHeight);
}
