// Picking points of clouds, as large as viser's shader draws them.

import { lensOf } from "webviz/scene/picking/lens.js";
import { planeOf } from "webviz/scene/points.js";

/** @import {Box, SceneObject, Vec2, Vec3} from "webviz/types.js" */

const ROUND = 1000; // above this, the norm of its outline makes a point a square

// The coordinates of the points that are drawn, which may be the first ones only.
/** @param {SceneObject} points */
const coordinatesOf = ({ geometry: { attributes, drawRange } }) =>
  attributes.position?.array.subarray(
    0,
    3 * Math.min(drawRange.count, attributes.position.count),
  ) ?? [];

/**
 * The point under a place of the canvas, or the nearest within `near` pixels: `{number, depth, off}`.
 *
 * @param {SceneObject} points
 * @param {Vec2} at
 * @param {number} near
 */
export function pointAt(points, [atX, atY], near) {
  const { m, v, wide, tall, dpr } = lensOf(points);
  const xyz = coordinatesOf(points);
  const { scale, point_ball_norm: norm } = points.material.uniforms;
  const half = scale.value / 2 / dpr; // times 1 / depth
  const [a, b, c, d] = planeOf(points);
  const isSquare = norm.value > ROUND;
  const [midX, midY] = [wide / 2, tall / 2];
  let index = -1;
  let off = Infinity;
  let nearest = Infinity;
  for (let i = 0, j = 0; j < xyz.length; i++, j += 3) {
    const [x, y, z] = [xyz[j], xyz[j + 1], xyz[j + 2]];
    const w = m[3] * x + m[7] * y + m[11] * z + m[15];
    const depth = -(v[2] * x + v[6] * y + v[10] * z + v[14]);
    if (!(w > 0 && depth > 0)) continue;
    const reach = Math.max((half * (a * x + b * y + c * z + d)) / depth, 0.5 / dpr);
    const dx = Math.abs(((m[0] * x + m[4] * y + m[8] * z + m[12]) / w + 1) * midX - atX);
    if (dx > reach && dx > near) continue;
    const dy = Math.abs((1 - (m[1] * x + m[5] * y + m[9] * z + m[13]) / w) * midY - atY);
    if (dy > reach && dy > near) continue;
    const beside = Math.hypot(dx, dy);
    const isOn = isSquare ? dx <= reach && dy <= reach : beside <= reach;
    if (!isOn && beside > near) continue;
    const away = isOn ? 0 : beside;
    if (away < off || (away === off && depth <= nearest)) {
      index = i;
      off = away;
      nearest = depth;
    }
  }
  return index < 0 ? null : { number: index, depth: nearest, off };
}

/**
 * Calls `take(number)` for each point whose middle is in a box of the canvas.
 *
 * @param {SceneObject} points
 * @param {Box} box
 * @param {(number: number) => unknown} take
 */
export function pointsIn(points, { left, top, right, bottom }, take) {
  const { m, v, wide, tall } = lensOf(points);
  const xyz = coordinatesOf(points);
  const [midX, midY] = [wide / 2, tall / 2];
  for (let i = 0, j = 0; j < xyz.length; i++, j += 3) {
    const [x, y, z] = [xyz[j], xyz[j + 1], xyz[j + 2]];
    const w = m[3] * x + m[7] * y + m[11] * z + m[15];
    if (!(w > 0 && v[2] * x + v[6] * y + v[10] * z + v[14] < 0)) continue;
    const across = ((m[0] * x + m[4] * y + m[8] * z + m[12]) / w + 1) * midX;
    if (!(across >= left && across <= right)) continue;
    const down = (1 - (m[1] * x + m[5] * y + m[9] * z + m[13]) / w) * midY;
    if (down >= top && down <= bottom) take(i);
  }
}

/**
 * Return where a point is in the coordinates of the cloud.
 *
 * @param {SceneObject} points
 * @param {number} number
 * @returns {Vec3 | []} empty for a point that is gone
 */
export function pointOf(points, number) {
  /** @type {ArrayLike<number> | undefined} */
  const xyz = points.geometry.attributes.position?.array;
  const i = 3 * number;
  return xyz && i + 2 < xyz.length ? [xyz[i], xyz[i + 1], xyz[i + 2]] : [];
}

/**
 * The colour of a point, null if all have the same.
 *
 * @param {SceneObject} points
 * @param {number} number
 * @returns {Vec3 | null}
 */
export function colorOf(points, number) {
  const colors = points.geometry.attributes.color?.array;
  if (!colors) return null;
  const [red, green, blue] = colors.subarray(3 * number, 3 * number + 3);
  return [red, green, blue];
}
