// The part of a recording that the timeline shows, in seconds from its start.

import { changed } from "../charts/scale.js";

/** @import {Range} from "../types.js" */

const MIN_S = 0.01;

/**
 * The seconds that a whole timeline shows; those of a recording of one moment have room for it, too.
 *
 * @param {number} duration
 */
export const shownLength = (duration) => Math.max(duration, MIN_S);

/**
 * A window within 0 and `duration` that is at least a hundredth of a second long.
 *
 * @param {Range} range
 * @param {number} duration
 * @returns {Range}
 */
export function limited([first, last], duration) {
  const length = Math.min(Math.max(last - first, Math.min(MIN_S, duration)), duration);
  const from = Math.min(Math.max(first, 0), duration - length);
  return [from, from + length];
}

/**
 * A window that is scaled around the place at a share of it, or moved by a share of it.
 *
 * @param {Range} range
 * @param {{around?: number, by?: number, move?: number}} change
 * @param {number} duration
 */
export const zoomed = (range, change, duration) => limited(changed(range, change), duration);

/**
 * The window moved on or back by whole windows, if a time is not in it.
 *
 * @param {Range} range
 * @param {number} time
 * @param {number} duration
 * @returns {Range}
 */
export function following([first, last], time, duration) {
  if (time >= first && time <= last) return [first, last];
  const length = last - first;
  const from = length * Math.floor(time / length);
  return limited([from, from + length], duration);
}
