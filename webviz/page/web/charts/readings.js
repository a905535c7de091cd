// Readings of curves: their values at a time, and statistics.

import { visit } from "webviz/charts/curves.js";
import { numberText, withUnit } from "webviz/charts/scale.js";

/** @import {Curve, Range} from "webviz/types.js" */

const SPAN = 0.001; // of which numbers have the digits

/**
 * The finite values of a curve in a range of time: their number, lowest, highest and mean.
 *
 * @param {Curve} curve
 * @param {Range} range
 */
export function statistics(curve, range) {
  let [count, low, high, mean] = [0, Infinity, -Infinity, 0];
  visit(curve, range, (time, value) => {
    if (!Number.isFinite(value) || time < range[0] || time > range[1]) return;
    count += 1;
    low = Math.min(low, value);
    high = Math.max(high, value);
    mean += value / count - mean / count; // a sum of large values overflows
  });
  return { count, low, high, mean };
}

/**
 * The newest value up to a time, null if there is none.
 *
 * @param {Curve} curve
 * @param {number} time
 */
export function valueAt({ pieces }, time) {
  for (const { times, values } of pieces.toReversed()) {
    if (!times.length || times[0] > time) continue;
    let [low, high] = [0, times.length - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= time) low = middle;
      else high = middle - 1;
    }
    return { time: times[low], value: values[low] };
  }
  return null;
}

/**
 * The value of a curve at a time, "" for none.
 *
 * @param {Curve} curve
 * @param {number} time
 */
export function valueText(curve, time) {
  const sample = valueAt(curve, time);
  if (!sample) return "";
  return Number.isNaN(sample.value)
    ? "no value"
    : withUnit(numberText(sample.value, SPAN), curve.unit);
}

/**
 * The statistics of a curve in a range of time.
 *
 * @param {Curve} curve
 * @param {Range} range
 */
export function sumsText(curve, range) {
  const { count, low, high, mean } = statistics(curve, range);
  if (!count) return "No values in this span.";
  const [least, most, middle] = [low, high, mean].map((each) => numberText(each, SPAN));
  const sums = withUnit(`min ${least}, max ${most}, mean ${middle}`, curve.unit);
  return `${sums}, ${count} values`;
}
