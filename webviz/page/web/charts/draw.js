// Draws curves, grid and cursor of a chart on a canvas.

import { fitted } from "./canvas.js";
import { timeOfDay } from "../shell/time_text.js";
import { visit } from "./curves.js";
import { numberText, share, ticks } from "./scale.js";

/** @import {Area, Curve, Range} from "../types.js" */

export const LEFT = 52;
export const BOTTOM = 18;
const TOP = 6;
const RIGHT = 6;
const PER_TICK = [70, 36];

/**
 * The part of a canvas of this size that curves are drawn in.
 *
 * @param {number} width
 * @param {number} height
 * @returns {Area}
 */
export const inside = (width, height) => ({
  left: LEFT,
  top: TOP,
  width: Math.max(1, width - LEFT - RIGHT),
  height: Math.max(1, height - TOP - BOTTOM),
});

/**
 * Draws `{curves, colors, times, values, cursor}`: ranges of both axes, and a time or null.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {{curves: Curve[], colors: (key: number) => string, times: Range, values: Range, cursor: number | null}} shown
 */
export function draw(canvas, { curves, colors, times, values, cursor }) {
  const { context, ratio, width, height } = fitted(canvas);
  const area = inside(width, height);
  /** @param {number} time */
  const x = (time) => area.left + share(time, times) * area.width;
  /** @param {number} value */
  const y = (value) => area.top + (1 - share(value, values)) * area.height;
  const style = getComputedStyle(canvas);
  grid(context, area, { times, values, x, y }, style);
  context.save();
  context.beginPath();
  context.rect(area.left, area.top, area.width, area.height);
  context.clip();
  curves.forEach((curve) => line(context, curve, { times, x, y, color: colors(curve.key), ratio }));
  if (cursor !== null) {
    context.strokeStyle = style.getPropertyValue("--wv-quiet");
    stroke(context, x(cursor), area.top, x(cursor), area.top + area.height);
  }
  context.restore();
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Area} area
 * @param {{times: Range, values: Range, x: (time: number) => number, y: (value: number) => number}} axes
 * @param {CSSStyleDeclaration} style
 */
function grid(context, area, { times, values, x, y }, style) {
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
  context.textBaseline = "top";
  context.textAlign = "center";
  for (const time of ticks(...times, Math.max(2, area.width / PER_TICK[0]))) {
    stroke(context, x(time), area.top, x(time), area.top + area.height);
    const text = tickText(time, times[1] - times[0]);
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

// Of the values in one column of the screen the first, lowest, highest and last are drawn.
/**
 * @param {CanvasRenderingContext2D} context
 * @param {Curve} curve
 * @param {{times: Range, x: (time: number) => number, y: (value: number) => number, color: string, ratio: number}} axes
 */
function line(context, curve, { times, x, y, color, ratio }) {
  let [column, low, high, last, isDown] = [NaN, 0, 0, 0, false];
  const finish = () => {
    if (low !== high) {
      context.lineTo(column / ratio, low);
      context.lineTo(column / ratio, high);
      context.lineTo(column / ratio, last);
    }
  };
  context.strokeStyle = color;
  context.lineWidth = 1.5;
  context.lineJoin = "round";
  context.beginPath();
  visit(curve, times, (time, value) => {
    if (Number.isNaN(value)) {
      if (isDown) finish();
      isDown = false;
      column = NaN;
      return;
    }
    const [place, level] = [Math.round(x(time) * ratio), y(value)];
    if (place === column) {
      [low, high, last] = [Math.min(low, level), Math.max(high, level), level];
      return;
    }
    if (isDown) finish();
    if (isDown) context.lineTo(place / ratio, level);
    else {
      context.moveTo(place / ratio, level);
      context.lineTo(place / ratio + 0.5, level); // so that a single value can be seen
    }
    [column, low, high, last, isDown] = [place, level, level, level, true];
  });
  if (isDown) finish();
  context.stroke();
}
