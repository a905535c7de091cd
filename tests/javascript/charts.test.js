import assert from "node:assert/strict";
import { test } from "node:test";

import {
  byAxis,
  csv,
  curvesOf,
  extent,
  pairs,
  visit,
} from "../../webviz/page/web/charts/curves.js";
import { statistics, sumsText, valueAt, valueText } from "../../webviz/page/web/charts/readings.js";
import { changed, numberText, roomy, share, ticks } from "../../webviz/page/web/charts/scale.js";
import { boxBetween, boxed, panned, scaled, shareOf } from "../../webviz/page/web/charts/zoom.js";

/** @import {AxisRanges} from "webviz/charts/zoom.js" */
/** @import {Curve, Facts, Range} from "webviz/types.js" */

const LARGEST = Number.MAX_VALUE;
/**
 * @param {Iterable<number>} times
 * @param {Iterable<number>} values
 */
const piece = (times, values) => ({
  times: Float64Array.from(times),
  values: Float64Array.from(values),
});
/**
 * A curve with what a test says of it.
 *
 * @param {Partial<Curve>} said
 * @returns {Curve}
 */
const curve = (said) => ({
  key: 0,
  name: "",
  problem: "",
  pieces: [],
  axis: 0,
  unit: "",
  ...said,
});
const TWO = curve({ pieces: [piece([], []), piece([0, 1], [5, 6]), piece([2, 3], [7, NaN])] });

/**
 * @param {Curve} curve
 * @param {Range} range
 */
function visited(curve, range) {
  /** @type {number[]} */
  const times = [];
  visit(curve, range, (time) => times.push(time));
  return times;
}

test("statistics are of the finite values within a range, and do not overflow", () => {
  assert.deepEqual(statistics(TWO, [0.5, 3]), { count: 2, low: 6, high: 7, mean: 6.5 });
  assert.equal(statistics(TWO, [8, 9]).count, 0);
  const large = curve({ pieces: [piece([0, 1, 2], [LARGEST, LARGEST, -LARGEST])] });
  const { low, high, mean } = statistics(large, [0, 2]);
  assert.deepEqual([low, high], [-LARGEST, LARGEST]);
  assert.ok(Math.abs(mean / LARGEST - 1 / 3) < 1e-9);
});

test("a curve over another has the values of both at the same times", () => {
  const across = curve({ pieces: [piece([0, 1], [10, 11]), piece([2, 3], [12, 13])] });
  assert.deepEqual(pairs(TWO, across, [0, 3]), [
    [10, 5],
    [11, 6],
    [12, 7],
    [13, NaN],
  ]);
  assert.deepEqual(pairs(TWO, across, [2, 2.5]).slice(-2), [
    [12, 7],
    [13, NaN],
  ]);
  assert.deepEqual(pairs(TWO, curve({}), [0, 3]), []);
  assert.deepEqual(pairs(TWO, curve({ pieces: [piece([1.5], [9])] }), [0, 3]), [
    [9, 7],
    [9, NaN],
  ]);
});

test("ticks are round numbers within their range", () => {
  assert.deepEqual(ticks(0, 10, 5), [0, 2, 4, 6, 8, 10]);
  assert.deepEqual(
    ticks(-0.3, 0.3, 3).map((each) => each.toFixed(1)),
    ["-0.2", "0.0", "0.2"],
  );
  assert.deepEqual(ticks(1e-300, 3e-300, 2), [1e-300, 2e-300, 3e-300]);
});

test("a round number at an end has a tick, however the end was rounded", () => {
  const now = 1_764_000_000.123 - 1_763_999_910.123;
  for (const by of [-1e-7, 0, 1e-7])
    assert.deepEqual(ticks(now - 60 - now + by, 0, 3), [-60, -40, -20, 0], String(by));
  assert.deepEqual(ticks(-59.99, 0, 3), [-40, -20, 0]);
});

test("extreme ranges have few ticks and an empty range none", () => {
  const widest = ticks(-LARGEST, LARGEST, 5);
  assert.ok(widest.length > 2 && widest.every(Number.isFinite), String(widest));
  assert.ok(ticks(1e17, 1e17 + 16, 4).length <= 50);
  for (const [low, high] of [
    [1, 1],
    [2, 1],
    [NaN, 1],
    [0, NaN],
  ])
    assert.deepEqual(ticks(low, high, 5), []);
});

test("a range of values has room around it and is never empty", () => {
  assert.deepEqual(roomy(0, 10), [-0.5, 10.5]);
  assert.deepEqual(roomy(100, 100), [95, 105]);
  assert.deepEqual(roomy(0, 0), [-1, 1]);
  assert.deepEqual(roomy(Infinity, -Infinity), [-1, 1], "of no values");
  assert.deepEqual(roomy(-LARGEST, LARGEST), [-LARGEST, LARGEST]);
});

test("shares of a range are right where its span overflows", () => {
  assert.equal(share(2.5, [0, 10]), 0.25);
  assert.equal(share(0, [-LARGEST, LARGEST]), 0.5);
});

test("a range is scaled around a share of it and moved by another", () => {
  assert.deepEqual(changed([0, 8], { around: 0.25, by: 0.5 }), [1, 5]);
  assert.deepEqual(changed([0, 8], { move: -0.25 }), [-2, 6]);
});

test("numbers have the digits that the span of their axis needs", () => {
  assert.equal(numberText(1.23456, 1), "1.23");
  assert.equal(numberText(100, 10), "100");
  assert.equal(numberText(1.5, 0), "1.5");
  assert.equal(numberText(1e308, 1), "1e+308");
  assert.equal(numberText(1_234_567, 1), "1.235e+6");
  assert.equal(numberText(0.00005, 1), "5e-5");
  assert.equal(numberText(-0.001, 1000), "0");
  assert.equal(numberText(NaN, 1), "NaN");
});

test("curves are made of the pieces that have come, and unchanged pieces stay the same objects", () => {
  const values = new Map([["plot/8.3", { start: 100, times: [0, 0.5], values: [1, null] }]]);
  /** @type {Facts[]} */
  const facts = [{ key: 8, name: "/a", problem: "", chunks: [2, 4], axis: 0, unit: "" }];
  const cache = new WeakMap();
  const [{ pieces }] = curvesOf(facts, values, "plot", cache);
  assert.deepEqual(pieces, [piece(Float64Array.of(100, 100.5), Float64Array.of(1, NaN))]);
  assert.equal(curvesOf(facts, values, "plot", cache)[0].pieces[0], pieces[0]);
});

test("a line is drawn from the value before a range to the one behind it", () => {
  assert.deepEqual(visited(TWO, [0.5, 1.5]), [0, 1, 2]);
  assert.deepEqual(visited(TWO, [1.2, 1.4]), [1, 2]);
  assert.deepEqual(visited(TWO, [5, 9]), [3]);
  assert.deepEqual(visited(TWO, [-5, -1]), [0]);
  assert.deepEqual(visited(curve({}), [0, 1]), []);
});

test("the extent of curves leaves out NaN", () => {
  assert.deepEqual(extent([TWO, curve({ pieces: [piece([1], [-1e308])] })], [0, 9]), [-1e308, 7]);
  assert.deepEqual(extent([curve({ pieces: [piece([1], [NaN])] })], [0, 9]), [Infinity, -Infinity]);
});

test("the value at a time is the newest up to then", () => {
  assert.deepEqual(valueAt(TWO, 1.9), { time: 1, value: 6 });
  assert.deepEqual(valueAt(TWO, 2), { time: 2, value: 7 });
  assert.deepEqual(valueAt(TWO, 99), { time: 3, value: NaN });
  assert.equal(valueAt(TWO, -0.1), null);
  const times = Array.from({ length: 1000 }, (_, i) => i);
  const long = curve({ pieces: [piece(times, times)] });
  for (const time of [637, 637.5]) assert.deepEqual(valueAt(long, time), { time: 637, value: 637 });
});

test("CSV quotes names and leaves gaps out", () => {
  const pieces = [piece([1, 2, 3], [1e308, NaN, Infinity])];
  const curves = [curve({ name: 'a "b",ü', pieces })];
  assert.equal(csv(curves), 'curve,time (s),value\n"a ""b"",ü",1.000000,1e+308\n');
  assert.match(csv([curve({ name: "=1+1", pieces })]), /\n"'=1\+1",1\.000000,/);
  assert.equal(csv([]), "curve,time (s),value\n");
});

test("curves stand at their axes, apart from the one in place of time", () => {
  const curves = [2, 0, 1, 0, 2].map((axis, key) => curve({ key, axis }));
  /** @param {Curve[]} group */
  const keysOf = (group) => group.map(({ key }) => key);
  /** @param {ReturnType<typeof byAxis>} axes */
  const keys = ({ across, left, rights }) => [across?.key, keysOf(left), ...rights.map(keysOf)];
  assert.deepEqual(keys(byAxis(curves, -1)), [undefined, [1, 3], [2], [0, 4]]);
  assert.deepEqual(keys(byAxis(curves, 2)), [2, [1, 3], [0, 4]]);
  assert.deepEqual(keys(byAxis([], 0)), [undefined, []]);
});

test("a legend has values with units and marks missing ones", () => {
  const speed = { ...TWO, unit: "m/s" };
  assert.equal(valueText(speed, 1.5), "6 m/s");
  assert.equal(valueText(speed, Infinity), "no value");
  assert.equal(valueText(speed, -1), "");
  assert.equal(sumsText(speed, [0, 2]), "min 5, max 7, mean 6 m/s, 3 values");
  assert.equal(sumsText(speed, [8, 9]), "No values in this span.");
});

/** @type {AxisRanges} */
const SHOWN = { times: [0, 10], values: [-1, 1] };
const AREA = { left: 50, top: 10, width: 200, height: 100 };

test("the wheel zooms times or values, and values that were zoomed stay so", () => {
  const change = { around: 0, by: 0.5 };
  assert.deepEqual(scaled(SHOWN, null, change, false), { times: [0, 5], values: null });
  assert.deepEqual(scaled(SHOWN, SHOWN, change, false), { times: [0, 5], values: [-1, 1] });
  assert.deepEqual(scaled(SHOWN, null, change, true), { times: [0, 10], values: [-1, 0] });
});

test("a zoom to almost no time, or to too much, is ignored", () => {
  /** @type {AxisRanges} */
  const short = { ...SHOWN, times: [5, 5 + 1.5e-6] };
  assert.equal(scaled(short, null, { by: 0.5 }, false), null);
  assert.equal(scaled({ ...SHOWN, times: [0, 9e5] }, null, { by: 1.2 }, false), null);
  assert.equal(scaled({ ...SHOWN, times: [NaN, NaN] }, null, {}, false), null);
});

test("a drag moves times, and values if it goes up", () => {
  assert.deepEqual(panned(SHOWN, [0.1, 0.5], false), { times: [-1, 9], values: null });
  assert.deepEqual(panned(SHOWN, [0.1, 0.5], true), { times: [-1, 9], values: [-2, 0] });
});

test("a box drawn in any direction is zoomed to, a line is not", () => {
  assert.deepEqual(boxed(SHOWN, [0.75, 0], [0.25, 0.5]), { times: [2.5, 7.5], values: [-1, 0] });
  assert.equal(boxed(SHOWN, [0.2, 0.5], [0.8, 0.504]), null);
  assert.deepEqual(shareOf([100, 35], AREA), [0.25, 0.75]);
  const pixels = { left: 100, top: 60, width: 100, height: 50 };
  assert.deepEqual(boxBetween([0.75, 0], [0.25, 0.5], AREA), pixels);
});
