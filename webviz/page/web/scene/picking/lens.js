// Projection of an object's coordinates by the camera: the base of picking, which looks at every point
// of a cloud and every line itself. A ray of three.js tests each against its own sphere, which takes
// seconds for a large cloud, and does not know how large points are drawn.

import * as viser from "webviz/viser_page.js";

/** @import {Vector3} from "three" */
/** @import {SceneObject, Vec2, Vec3} from "webviz/types.js" */

/**
 * `{m, v, wide, tall, dpr, grow}` of an object: `m` takes its coordinates to the clip space, `v` to the
 * camera's; the canvas is `wide` and `tall` CSS pixels, each `dpr` pixels of the screen; a metre is
 * `grow` / w pixels.
 *
 * @param {Pick<SceneObject, "matrixWorld">} object
 */
export function lensOf(object) {
  const camera = viser.camera();
  const modelView = camera.matrixWorldInverse.clone().multiply(object.matrixWorld);
  const { clientWidth: wide, clientHeight: tall } = viser.canvas();
  return {
    v: modelView.elements,
    m: camera.projectionMatrix.clone().multiply(modelView).elements,
    grow: (camera.projectionMatrix.elements[5] * tall) / 2,
    wide,
    tall,
    dpr: viser.gl().getPixelRatio(),
  };
}

/**
 * A point of the window in pixels of the canvas: the middle of the pixel of the screen there.
 *
 * @param {Vec2} xy
 * @returns {Vec2}
 */
export function onCanvasAt([x, y]) {
  const { left, top } = viser.canvas().getBoundingClientRect();
  const dpr = viser.gl().getPixelRatio();
  /** @param {number} place */
  const middle = (place) => (Math.floor(place * dpr) + 0.5) / dpr;
  return [middle(x - left), middle(y - top)];
}

/**
 * The depth of a point in three.js' coordinates: metres in front of the camera.
 *
 * @param {Vector3} point
 * @returns {number}
 */
export const depthOf = (point) => -point.clone().applyMatrix4(viser.camera().matrixWorldInverse).z;

/**
 * The size of a pixel at a depth, in metres.
 *
 * @param {number} depth
 * @returns {number}
 */
export function pixelAt(depth) {
  const { elements } = viser.camera().projectionMatrix;
  const w = elements[15] - elements[11] * depth; // depth, or 1 without perspective
  return (2 * w) / (elements[5] * viser.canvas().clientHeight);
}

/**
 * Return where a point of an object is on the canvas, in CSS pixels, or null behind the camera.
 *
 * @param {{m: number[], v: number[], wide: number, tall: number}} lens
 * @param {Vec3} xyz
 * @returns {Vec2 | null}
 */
export function project({ m, v, wide, tall }, [x, y, z]) {
  const w = m[3] * x + m[7] * y + m[11] * z + m[15];
  if (w <= 0 || -(v[2] * x + v[6] * y + v[10] * z + v[14]) <= 0) return null;
  const across = (m[0] * x + m[4] * y + m[8] * z + m[12]) / w;
  const up = (m[1] * x + m[5] * y + m[9] * z + m[13]) / w;
  return [((across + 1) / 2) * wide, ((1 - up) / 2) * tall];
}
