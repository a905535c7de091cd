// Ranges of values and of time, and the round numbers at their axes.

import { fixed } from "webviz/numbers.js";

/** @import {Range} from "webviz/types.js" */

const EDGE = 1e-6; // of a step, by which rounding may put a round number at an end outside

/**
 * Round numbers within a range, about `count` of them.
 *
 * @param {number} low
 * @param {number} high
 * @param {number} count
 */
export function ticks(low, high, count) {
  const span = high / count - low / count; // of 1e308 and -1e308, too
  if (!(span > 0)) return [];
  const power = 10 ** Math.floor(Math.log10(span));
  const step = power * ([1, 2, 5].find((each) => each * power >= span * 0.999) ?? 10);
  /** @type {number[]} */
  const positions = [];
  const first = Math.ceil(low / step - EDGE) || 0; // never -0
  for (let i = first; i <= high / step + EDGE && positions.length < 50; i++)
    positions.push(i * step);
  return positions;
}

/**
 * The range of values with some room around it; one that is not empty.
 *
 * @param {number} low
 * @param {number} high
 * @returns {Range}
 */
export function roomy(low, high) {
  if (!(low <= high)) return [-1, 1];
  const margin = (high / 2 - low / 2) * 0.1 || Math.abs(low) * 0.05 || 1;
  const most = Number.MAX_VALUE;
  return [Math.max(-most, low - margin), Math.min(most, high + margin)];
}

/**
 * Return the place of a value in a range, between 0 and 1.
 *
 * @param {number} value
 * @param {Range} range
 */
export const share = (value, [low, high]) => (value / 2 - low / 2) / (high / 2 - low / 2);

/**
 * The value at a share of a range.
 *
 * @param {number} share_
 * @param {Range} range
 */
export const at = (share_, [low, high]) => low * (1 - share_) + high * share_;

/**
 * A range that is scaled around the place at a share of it, and moved by a share.
 *
 * @param {Range} range
 * @param {{around?: number, by?: number, move?: number}} change
 * @returns {Range}
 */
export function changed(range, { around = 0.5, by = 1, move = 0 }) {
  return [at(around - around * by + move, range), at(around + (1 - around) * by + move, range)];
}

/**
 * A number with as many digits as the span of its axis needs.
 *
 * @param {number} value
 * @param {number} span
 */
export function numberText(value, span) {
  const size = Math.abs(value);
  if (size && (size >= 1e6 || size < 1e-4)) return value.toExponential(3).replace(/\.?0+e/, "e");
  const digits = span > 0 ? Math.min(9, Math.max(0, 2 - Math.floor(Math.log10(span)))) : 3;
  return fixed(value, digits)
    .replace(/(\.\d*?)0+$/, "$1")
    .replace(/\.$/, "");
}

/**
 * A number with its unit, if it has one.
 *
 * @param {string} text
 * @param {string} unit
 */
export const withUnit = (text, unit) => (unit ? `${text} ${unit}` : text);
