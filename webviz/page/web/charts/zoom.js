// The part of its curves that a chart shows, as gestures change it. Without a document.

import { at, changed } from "webviz/charts/scale.js";

/** @import {Area, Range, Vec2} from "webviz/types.js" */

/**
 * @typedef {{times: Range, values: Range}} AxisRanges ranges of the axes
 * @typedef {{times: Range, values: Range | null}} Zoom `values` is null for the range that fits
 */

const SHORTEST_S = 1e-6;
const LONGEST_S = 1e6;
const LEAST_SHARE = 0.005; // of the area, for a box

/**
 * The place of a point of a canvas in the area of the curves, from 0 to 1 each, y upwards.
 *
 * @param {Vec2} point
 * @param {Area} area
 * @returns {Vec2}
 */
export const shareOf = ([x, y], { left, top, width, height }) => [
  (x - left) / width,
  1 - (y - top) / height,
];

/**
 * The zoom after a step of the wheel or a key, null where times would be too short or too long.
 *
 * @param {AxisRanges} ranges
 * @param {Zoom | null} zoom
 * @param {{around?: number, by?: number, move?: number}} change
 * @param {boolean} isValues whether it is that of the values, not of the times
 * @returns {Zoom | null}
 */
export function scaled({ times, values }, zoom, change, isValues) {
  const next = isValues
    ? { times, values: changed(values, change) }
    : { times: changed(times, change), values: zoom?.values ?? null };
  const length = next.times[1] - next.times[0];
  return length > SHORTEST_S && length <= LONGEST_S ? next : null;
}

/**
 * The zoom after a drag by shares of the area, of values only if it `isUp`.
 *
 * @param {AxisRanges} ranges as the drag began
 * @param {Vec2} by
 * @param {boolean} isUp
 * @returns {Zoom}
 */
export const panned = ({ times, values }, [dx, dy], isUp) => ({
  times: changed(times, { move: -dx }),
  values: isUp ? changed(values, { move: -dy }) : null,
});

/**
 * The zoom to the box between two places in shares of the area, null if it is too small.
 *
 * @param {AxisRanges} ranges
 * @param {Vec2} a
 * @param {Vec2} b
 * @returns {Zoom | null}
 */
export function boxed({ times, values }, a, b) {
  if (Math.min(Math.abs(a[0] - b[0]), Math.abs(a[1] - b[1])) <= LEAST_SHARE) return null;
  /**
   * @param {0 | 1} i
   * @param {Range} range
   * @returns {Range}
   */
  const part = (i, range) => [at(Math.min(a[i], b[i]), range), at(Math.max(a[i], b[i]), range)];
  return { times: part(0, times), values: part(1, values) };
}

/**
 * The rectangle between two places in shares of the area, in pixels of the canvas.
 *
 * @param {Vec2} a
 * @param {Vec2} b
 * @param {Area} area
 * @returns {Area}
 */
export const boxBetween = (a, b, { left, top, width, height }) => ({
  left: left + Math.min(a[0], b[0]) * width,
  top: top + (1 - Math.max(a[1], b[1])) * height,
  width: Math.abs(a[0] - b[0]) * width,
  height: Math.abs(a[1] - b[1]) * height,
});
