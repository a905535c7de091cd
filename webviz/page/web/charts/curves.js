// The values of curves, as the server sends them in pieces, and what is drawn of them.

import { csvText } from "webviz/csv.js";

/** @import {Curve, Facts, Piece, Range, ValuesOf, Vec2} from "webviz/types.js" */

/**
 * Of each curve `{key, name, problem, unit, pieces}`; a piece is `{times, values}`, in ROS seconds.
 *
 * @param {Facts[]} facts
 * @param {ValuesOf<"panel">} values
 * @param {string} id
 * @param {WeakMap<object, Piece>} cache
 * @returns {Curve[]}
 */
export function curvesOf(facts, values, id, cache) {
  return facts.map(({ key, name, problem, axis, unit, chunks: [first, end] }) => {
    /** @type {Piece[]} */
    const pieces = [];
    for (let number = first; number < end; number++) {
      const part = values.get(`${id}/${key}.${number}`);
      if (part) pieces.push(pieceOf(/** @type {Parameters<typeof pieceOf>[0]} */ (part), cache));
    }
    return { key, name, problem, axis, unit, pieces };
  });
}

/**
 * Curves by their axis: at the left, at the right, and the one in place of time, null for none.
 *
 * @param {Curve[]} curves
 * @param {number} key of the one in place of time
 */
export function byAxis(curves, key) {
  const across = curves.find((curve) => curve.key === key) ?? null;
  const others = curves.filter((curve) => curve !== across);
  const axes = [...new Set(others.map(({ axis }) => axis))].toSorted((a, b) => a - b);
  const [left, ...rights] = [0, ...axes.filter((axis) => axis > 0)].map((axis) =>
    others.filter((curve) => curve.axis === axis),
  );
  return { across, left, rights };
}

// A piece that has not changed is the same object in the store.
/**
 * @param {{start: number, times: number[], values: (number | null)[]}} part
 * @param {WeakMap<object, Piece>} cache
 * @returns {Piece}
 */
function pieceOf(part, cache) {
  let piece = cache.get(part);
  if (!piece) {
    const times = Float64Array.from(part.times, (time) => part.start + time);
    piece = { times, values: Float64Array.from(part.values, (value) => value ?? NaN) };
    cache.set(part, piece);
  }
  return piece;
}

/**
 * The first index of sorted times that are not before a time, or with `isAfter` that are after it.
 *
 * @param {Float64Array} times
 * @param {number} time
 * @param {boolean} [isAfter]
 */
function indexOf(times, time, isAfter = false) {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time || (isAfter && times[middle] === time)) low = middle + 1;
    else high = middle;
  }
  return low;
}

/**
 * The parts of a curve's pieces in a range of time with the value at each side, from `first` to before
 * `end`.
 *
 * @param {Pick<Curve, "pieces">} curve
 * @param {Range} range
 * @returns {Generator<Piece & {first: number, end: number}>}
 */
export function* spans({ pieces }, [from, to]) {
  /** @type {Piece | null} */
  let before = null;
  for (const piece of pieces) {
    const { times } = piece;
    const count = times.length;
    if (!count) continue;
    if (times[count - 1] < from) {
      before = piece;
      continue;
    }
    const first = indexOf(times, from);
    if (before && first === 0) yield lastOf(before);
    before = null;
    const end = Math.min(indexOf(times, to, true) + 1, count);
    yield { ...piece, first: Math.max(first - 1, 0), end };
    if (times[end - 1] > to) return;
  }
  if (before) yield lastOf(before);
}

/** @param {Piece} piece */
const lastOf = (piece) => ({ ...piece, first: piece.times.length - 1, end: piece.times.length });

/**
 * Calls `take(time, value)` for the values of a curve in a range of time, and the one at each side.
 *
 * @param {Pick<Curve, "pieces">} curve
 * @param {Range} range
 * @param {(time: number, value: number) => void} take
 */
export function visit(curve, range, take) {
  for (const { times, values, first, end } of spans(curve, range)) {
    for (let i = first; i < end; i++) take(times[i], values[i]);
  }
}

/**
 * A curve whose times are the values that another curve has then, for drawing one over the other.
 *
 * @param {Curve} curve
 * @param {Curve} across
 * @param {Range} range of time
 * @returns {[number, number][]} NaN where the line ends
 */
export function pairs(curve, across, range) {
  /** @type {Vec2[]} */
  const places = [];
  visit(across, range, (time, value) => places.push([time, value]));
  /** @type {Vec2[]} */
  const points = [];
  let at = 0;
  visit(curve, range, (time, value) => {
    while (at + 1 < places.length && places[at + 1][0] <= time) at += 1;
    if (places.length && places[at][0] <= time) points.push([places[at][1], value]);
  });
  return points;
}

/**
 * The lowest and highest value of all curves in a range of time.
 *
 * @param {Curve[]} curves
 * @param {Range} range
 * @returns {Range}
 */
export function extent(curves, range) {
  /** @type {Range} */
  const all = [Infinity, -Infinity];
  for (const curve of curves) {
    const isInside = (/** @type {Piece} */ { times }) =>
      times[0] >= range[0] && times[times.length - 1] <= range[1];
    for (const piece of curve.pieces.filter(isInside)) {
      const [low, high] = boundsOf(piece);
      if (low <= high) [low, high].forEach((value) => widen(all, value));
    }
    const pieces = curve.pieces.filter((piece) => !isInside(piece));
    visit({ pieces }, range, (_, value) => widen(all, value));
  }
  return all;
}

/**
 * Widens a range by a value; NaN is none.
 *
 * @param {Range} range
 * @param {number} value
 */
function widen(range, value) {
  if (value < range[0]) range[0] = value;
  if (value > range[1]) range[1] = value;
}

/** @type {WeakMap<Piece, Range>} */
const bounds = new WeakMap();

/**
 * The lowest and highest value of a piece, which is never changed.
 *
 * @param {Piece} piece
 * @returns {Range}
 */
function boundsOf(piece) {
  let range = bounds.get(piece);
  if (!range) {
    range = [Infinity, -Infinity];
    for (const value of piece.values) widen(range, value);
    bounds.set(piece, range);
  }
  return range;
}

/**
 * All values as CSV: a line for each, with curve, time and value.
 *
 * @param {Curve[]} curves
 */
export function csv(curves) {
  const parts = ["curve,time (s),value\n"];
  for (const { name, pieces } of curves) {
    const first = csvText([[name]]).trimEnd();
    for (const { times, values } of pieces) {
      times.forEach((time, i) => {
        if (Number.isFinite(values[i])) parts.push(`${first},${time.toFixed(6)},${values[i]}\n`);
      });
    }
  }
  return parts.join("");
}
