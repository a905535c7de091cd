// Places of times in a timeline, in pixels from its left end. Without a document.

import { at, share } from "../../charts/scale.js";

/** @import {Range} from "../../types.js" */

export const MARGIN = 8;
const SNAP_PX = 5;

/**
 * The place of a time.
 *
 * @param {number} time
 * @param {Range} range the times at both ends
 * @param {number} width of the timeline
 */
export const placeOf = (time, range, width) => MARGIN + share(time, range) * (width - 2 * MARGIN);

/**
 * The share of the times between both ends that is left of a place.
 *
 * @param {number} x
 * @param {number} width
 */
export const shareAt = (x, width) => (x - MARGIN) / Math.max(1, width - 2 * MARGIN);

/**
 * The time at a place.
 *
 * @param {number} x
 * @param {Range} range
 * @param {number} width
 */
export const timeAt = (x, range, width) => at(shareAt(x, width), range);

/**
 * The nearest of what has a time and is near a place; the first of several as near, null for none.
 *
 * @template T
 * @param {T[]} marks
 * @param {(mark: T) => number} placeOf
 * @param {number} x
 */
export function nearest(marks, placeOf, x) {
  /** @param {T} mark */
  const away = (mark) => Math.abs(placeOf(mark) - x);
  const near = marks.filter((mark) => away(mark) <= SNAP_PX);
  return near.toSorted((a, b) => away(a) - away(b))[0] ?? null;
}
