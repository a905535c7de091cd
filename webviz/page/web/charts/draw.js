// Draws curves, grid and cursor of a chart on a canvas.

import { fitted } from "webviz/charts/canvas.js";
import { timeOfDay } from "webviz/time_text.js";
import { pairs, spans } from "webviz/charts/curves.js";
import { numberText, share, ticks } from "webviz/charts/scale.js";

/** @import {Area, Curve, Range, Vec2} from "webviz/types.js" */
/**
 * @typedef {{curve: Curve, range: Range}} Across another curve in place of time, and its values
 * @typedef {{axis: number, range: Range, color: string}} RightAxis with the colour of its only curve, or ""
 */

const LEFT = 52;
const BOTTOM = 18;
const TOP = 6;
const RIGHT = 6;
const PER_TICK = [70, 36];
const COLUMNS = 32; // of a curve in one stroke: a path that covers itself takes long, with its square

/**
 * The part of a canvas of this size that curves are drawn in.
 *
 * @param {number} width
 * @param {number} height
 * @param {number} [axes] at the right
 * @returns {Area}
 */
export const inside = (width, height, axes = 0) => ({
  left: LEFT,
  top: TOP,
  width: Math.max(1, width - LEFT - (axes * LEFT || RIGHT)),
  height: Math.max(1, height - TOP - BOTTOM),
});

/**
 * Draws `{curves, colors, times, values, rights, across, cursor}`: ranges of the axes, and a time or null.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {{
 *   curves: Curve[], colors: (key: number) => string, times: Range, values: Range, rights: RightAxis[],
 *   across: Across | null, cursor: number | null,
 * }} shown
 */
export function draw(canvas, { curves, colors, times, values, rights, across, cursor }) {
  const { context, ratio, width, height } = fitted(canvas);
  const area = inside(width, height, rights.length);
  /** @param {number} time */
  const x = (time) => area.left + share(time, times) * area.width;
  /** @param {number} value */
  const y = (value) => area.top + (1 - share(value, values)) * area.height;
  /** @param {Curve} curve */
  const yOf = ({ axis }) => {
    const range = rights.find((each) => each.axis === axis)?.range ?? values;
    return (/** @type {number} */ value) => area.top + (1 - share(value, range)) * area.height;
  };
  const style = getComputedStyle(canvas);
  if (across) {
    /** @param {number} value */
    const along = (value) => area.left + share(value, across.range) * area.width;
    grid(
      context,
      area,
      { times: across.range, values, rights, x: along, y, text: numberText },
      style,
    );
    clip(context, area);
    for (const curve of curves) {
      if (curve === across.curve) continue;
      const places = pairs(curve, across.curve, times);
      path(context, places, { x: along, y: yOf(curve), color: colors(curve.key) });
    }
    context.restore();
    return;
  }
  grid(context, area, { times, values, rights, x, y, text: tickText }, style);
  clip(context, area);
  for (const curve of curves) {
    const to = { times, x, y: yOf(curve), color: colors(curve.key), ratio };
    line(context, curve, to);
  }
  if (cursor !== null) {
    context.strokeStyle = style.getPropertyValue("--wv-quiet");
    stroke(context, x(cursor), area.top, x(cursor), area.top + area.height);
  }
  context.restore();
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Area} area
 */
function clip(context, { left, top, width, height }) {
  context.save();
  context.beginPath();
  context.rect(left, top, width, height);
  context.clip();
}

/**
 * Draws a curve over another one, with a dot at its newest value.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Vec2[]} places
 * @param {{x: (value: number) => number, y: (value: number) => number, color: string}} axes
 */
function path(context, places, { x, y, color }) {
  context.strokeStyle = context.fillStyle = color;
  context.lineWidth = 1.5;
  context.lineJoin = "round";
  context.beginPath();
  let isDown = false;
  for (const [across, value] of places) {
    const isFinite = Number.isFinite(across) && Number.isFinite(value);
    if (isFinite) context[isDown ? "lineTo" : "moveTo"](x(across), y(value));
    isDown = isFinite;
  }
  context.stroke();
  const newest = places.findLast(([across, value]) => Number.isFinite(across + value));
  if (!newest) return;
  context.beginPath();
  context.arc(x(newest[0]), y(newest[1]), 4, 0, 2 * Math.PI);
  context.fill();
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Area} area
 * @param {{
 *   times: Range, values: Range, rights: RightAxis[], x: (time: number) => number,
 *   y: (value: number) => number, text: (value: number, span: number) => string,
 * }} axes
 * @param {CSSStyleDeclaration} style
 */
function grid(context, area, { times, values, rights, x, y, text: textOf }, style) {
  context.lineWidth = 1;
  context.font = "11px system-ui, sans-serif";
  context.strokeStyle = style.getPropertyValue("--wv-line");
  context.fillStyle = style.getPropertyValue("--wv-quiet");
  context.textBaseline = "middle";
  context.textAlign = "right";
  for (const value of ticks(...values, Math.max(2, area.height / PER_TICK[1]))) {
    stroke(context, area.left, y(value), area.left + area.width, y(value));
    context.fillText(numberText(value, values[1] - values[0]), area.left - 4, y(value), LEFT - 6);
  }
  context.textAlign = "left";
  rights.forEach(({ range, color }, i) => {
    const edge = area.left + area.width + i * LEFT;
    const quiet = context.fillStyle;
    context.fillStyle = color || quiet;
    if (i > 0) stroke(context, edge, area.top, edge, area.top + area.height);
    for (const value of ticks(...range, Math.max(2, area.height / PER_TICK[1]))) {
      const level = area.top + (1 - share(value, range)) * area.height;
      stroke(context, edge, level, edge + 3, level);
      context.fillText(numberText(value, range[1] - range[0]), edge + 5, level, LEFT - 8);
    }
    context.fillStyle = quiet;
  });
  context.textBaseline = "top";
  context.textAlign = "center";
  for (const time of ticks(...times, Math.max(2, area.width / PER_TICK[0]))) {
    stroke(context, x(time), area.top, x(time), area.top + area.height);
    const text = textOf(time, times[1] - times[0]);
    const last = area.left + area.width + RIGHT - context.measureText(text).width / 2;
    context.fillText(text, Math.min(x(time), last), area.top + area.height + 4);
  }
}

/**
 * @param {number} time
 * @param {number} span
 */
function tickText(time, span) {
  const text = timeOfDay(time, span < 10).replace(/^.* /, "");
  return span < 10 ? text.slice(0, span < 1 ? undefined : -2) : text;
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {number} x1
 * @param {number} y1
 * @param {number} x2
 * @param {number} y2
 */
function stroke(context, x1, y1, x2, y2) {
  /** @param {number} place */
  const sharp = (place) => Math.round(place) + 0.5;
  context.beginPath();
  if (x1 === x2) [x1, x2] = [sharp(x1), sharp(x2)];
  else [y1, y2] = [sharp(y1), sharp(y2)];
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
  context.stroke();
}

/**
 * Draws a curve: of the values in one column of the screen the first, lowest, highest and last.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Curve} curve
 * @param {{times: Range, x: (time: number) => number, y: (value: number) => number, color: string, ratio: number}} axes
 */
function line(context, curve, { times: range, x, y, color, ratio }) {
  // Plots have millions of values: each costs a multiplication and three comparisons.
  const [from, to] = range;
  const start = x(from) * ratio;
  const pace = (x(to) * ratio - start) / (to - from);
  let [column, low, high, last, isDown, columns] = [NaN, 0, 0, 0, false, 0];
  const finish = () => {
    if (!isDown || low === high) return;
    for (const value of [low, high, last]) context.lineTo(column / ratio, y(value));
  };
  context.strokeStyle = color;
  context.lineWidth = 1.5;
  context.lineJoin = "round";
  context.beginPath();
  for (const { times, values, first, end } of spans(curve, range)) {
    for (let i = first; i < end; i++) {
      const value = values[i];
      const place = Math.round(start + (times[i] - from) * pace);
      if (place === column) {
        if (value < low) low = value;
        else if (value > high) high = value;
      }
      if (place === column && value === value) last = value;
      else {
        finish();
        if (isDown && (columns += 1) % COLUMNS === 0) {
          context.stroke();
          context.beginPath();
          context.moveTo(column / ratio, y(last));
        }
        const isValue = value === value; // NaN ends the line
        if (isValue && isDown) context.lineTo(place / ratio, y(value));
        else if (isValue) {
          context.moveTo(place / ratio, y(value));
          context.lineTo(place / ratio + 0.5, y(value)); // so that a single value can be seen
        }
        [column, isDown] = [isValue ? place : NaN, isValue];
        low = high = last = value;
      }
    }
  }
  finish();
  context.stroke();
}
