// Picking line segments, of widths in pixels or metres.

import { lensOf } from "webviz/scene/picking/lens.js";

/** @import {SceneObject, Vec2, Vec3} from "webviz/types.js" */

const NEAREST = 1e-3; // metres or more in front of the camera

/**
 * The segment under a place of the canvas, or the nearest within `near` pixels: `{number, depth, off}`.
 *
 * @param {SceneObject} lines
 * @param {Vec2} at
 * @param {number} near
 */
export function lineAt(lines, [atX, atY], near) {
  const { m, v, wide, tall, dpr, grow } = lensOf(lines);
  const xyz = lines.geometry.attributes.instanceStart?.data.array ?? [];
  const { linewidth, worldUnits } = lines.material;
  /** @type {any} */
  let best = null;
  for (let i = 0, j = 0; j < xyz.length; i++, j += 6) {
    const from = viewPoint(xyz, j);
    const to = viewPoint(xyz, j + 3);
    if (!(from.depth > NEAREST || to.depth > NEAREST)) continue;
    if (from.depth < NEAREST) cut(from, to);
    if (to.depth < NEAREST) cut(to, from);
    const [x0, y0, x1, y1] = [...place(from), ...place(to)];
    const [dx, dy] = [x1 - x0, y1 - y0];
    const square = dx * dx + dy * dy;
    const t = square ? ((atX - x0) * dx + (atY - y0) * dy) / square : 0;
    const along = Math.min(Math.max(t, 0), 1);
    const beside = Math.hypot(x0 + along * dx - atX, y0 + along * dy - atY);
    // What is linear on the screen is 1 / w, and depth / w.
    const inverse = (1 - along) / from.w + along / to.w;
    const depth = ((1 - along) * (from.depth / from.w) + along * (to.depth / to.w)) / inverse;
    const half = Math.max((worldUnits ? linewidth * grow * inverse : linewidth) / 2, 0.5 / dpr);
    const off = beside <= half ? 0 : beside;
    if (off > near || Number.isNaN(beside)) continue;
    if (!best || off < best.off || (off === best.off && depth < best.depth)) {
      best = { number: i, depth, off };
    }
  }
  return best;

  /**
   * @param {ArrayLike<number>} array
   * @param {number} at
   */
  function viewPoint(array, at) {
    const [x, y, z] = [array[at], array[at + 1], array[at + 2]];
    return {
      x: m[0] * x + m[4] * y + m[8] * z + m[12],
      y: m[1] * x + m[5] * y + m[9] * z + m[13],
      w: m[3] * x + m[7] * y + m[11] * z + m[15],
      depth: -(v[2] * x + v[6] * y + v[10] * z + v[14]),
    };
  }

  // Moves an end that is behind the camera to where the segment is in front of it.
  /**
   * @param {any} end
   * @param {any} other
   */
  function cut(end, other) {
    const share = (NEAREST - end.depth) / (other.depth - end.depth);
    for (const key of ["x", "y", "w", "depth"]) end[key] += share * (other[key] - end[key]);
  }

  /** @param {any} end */
  function place({ x, y, w }) {
    return [((x / w + 1) / 2) * wide, ((1 - y / w) / 2) * tall];
  }
}

/**
 * Return where a segment is, `[from, to]`, in the coordinates of the lines.
 *
 * @param {SceneObject} lines
 * @param {number} number
 * @returns {Vec3[]}
 */
export function lineOf(lines, number) {
  /** @type {ArrayLike<number> | undefined} */
  const xyz = lines.geometry.attributes.instanceStart?.data.array;
  if (!xyz || 6 * number >= xyz.length) return [];
  return [6 * number, 6 * number + 3].map((i) => [xyz[i], xyz[i + 1], xyz[i + 2]]);
}

/**
 * The number of segments.
 *
 * @param {SceneObject} lines
 * @returns {number}
 */
export const lineCount = (lines) =>
  (lines.geometry.attributes.instanceStart?.data.array.length ?? 0) / 6;
