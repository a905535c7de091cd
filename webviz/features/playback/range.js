// The part of a recording that the timeline shows, in seconds from its start, and places of times in it,
// in pixels from its left end. Without a document.

import { at, changed, share } from "webviz/charts/scale.js";

/** @import {Moment, Range} from "webviz/types.js" */

export const MARGIN = 8;
const SNAP_PX = 5;
const MIN_S = 0.01;

/**
 * The seconds that a whole timeline shows; those of a recording of one moment have room for it, too.
 *
 * @param {number} duration
 */
export const shownLength = (duration) => Math.max(duration, MIN_S);

/**
 * The first and the last second of a whole timeline: of live topics, what the memory can hold.
 *
 * @param {Moment} recording
 * @returns {Range}
 */
export function boundsOf(recording) {
  const last = recording.get("duration");
  if (recording.get("is_live") === null) return [0, shownLength(last)];
  const limit = recording.get("limit");
  return [Math.min(recording.get("first"), recording.get("is_live") ? last - limit : last), last];
}

/**
 * A window within the bounds that is at least a hundredth of a second long.
 *
 * @param {Range} range
 * @param {Range} bounds
 * @returns {Range}
 */
export function limited([first, last], [low, high]) {
  const most = high - low;
  const length = Math.min(Math.max(last - first, Math.min(MIN_S, most)), most);
  const from = Math.min(Math.max(first, low), high - length);
  return [from, from + length];
}

/**
 * A window that is scaled around the place at a share of it, or moved by a share of it.
 *
 * @param {Range} range
 * @param {{around?: number, by?: number, move?: number}} change
 * @param {Range} bounds
 */
export const zoomed = (range, change, bounds) => limited(changed(range, change), bounds);

/**
 * The window moved on or back by whole windows, if a time is not in it.
 *
 * @param {Range} range
 * @param {number} time
 * @param {Range} bounds
 * @returns {Range}
 */
export function following([first, last], time, bounds) {
  if (time >= first && time <= last) return [first, last];
  const length = last - first;
  const from = bounds[0] + length * Math.floor((time - bounds[0]) / length);
  return limited([from, from + length], bounds);
}

/**
 * The window within other bounds: all of them if it had all before, of another bag, or if its start is
 * no longer there.
 *
 * @param {Range} range
 * @param {Range} before
 * @param {Range} bounds
 * @param {boolean} isBag
 * @returns {Range}
 */
export function rebounded(range, before, bounds, isBag) {
  if (isSame(bounds, before)) return range;
  return isBag || isSame(range, before) || bounds[0] > range[0] ? bounds : range;
}

/**
 * @param {Range} a
 * @param {Range} b
 */
export const isSame = (a, b) => a[0] === b[0] && a[1] === b[1];

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
