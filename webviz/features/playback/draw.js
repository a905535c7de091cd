// Draws the timeline on a canvas: when there are messages, the span that is played, and the head.

import { share, ticks } from "webviz/charts/scale.js";
import { fitted } from "webviz/charts/canvas.js";
import { duration } from "webviz/time_text.js";
import { MARGIN, placeOf } from "webviz/features/playback/range.js";
import { beforeText } from "webviz/moment.js";

/** @import {LoggedEvent, Range} from "webviz/types.js" */

const TOP = 4;
const BAR = 12;
const PER_TICK = 90;
const PEAK = 3; // half the width of what marks an event

/**
 * Draws `{range, counted, counts, selected, bookmarks, events, past, position, hover}`: times in seconds, `selected`
 * and `hover` may be null, `bookmarks` are pairs of name and time, `events` begin with time and level.
 * `past` is what is remembered of live topics, `{first, now, gap}`, null for a bag.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {{range: Range, counted: Range, counts: number[], selected: Range | null,
 *   bookmarks: [string, number][], events: LoggedEvent[], position: number, hover: number | null,
 *   past: {first: number, now: number, gap: Range | null} | null}} shown
 */
export function draw(
  canvas,
  { range, counted, counts, selected, bookmarks, events, past, position, hover },
) {
  const { context, width, color } = fitted(canvas);
  /** @param {number} time */
  const x = (time) => placeOf(time, range, width);
  context.fillStyle = color("line");
  context.fillRect(MARGIN, TOP, width - 2 * MARGIN, BAR);
  context.save();
  context.beginPath();
  context.rect(MARGIN, TOP, width - 2 * MARGIN, BAR);
  context.clip();
  if (past) drawPast(context, past, { x, color });
  bars(context, counts, { x, counted, range, top: TOP, height: BAR, color: color("accent") });
  if (selected) {
    context.fillStyle = color("back");
    context.globalAlpha = 0.7;
    context.fillRect(0, TOP, x(selected[0]), BAR);
    context.fillRect(x(selected[1]), TOP, width, BAR);
    context.globalAlpha = 1;
  }
  context.restore();
  scale(context, range, { x, width, color, origin: past?.now ?? 0 });
  marks(context, events, { range, x, color });
  if (selected) {
    context.fillStyle = color("warn");
    for (const time of selected) context.fillRect(x(time) - 1, TOP - 2, 2, BAR + 4);
  }
  context.fillStyle = color("warn");
  for (const [, time] of bookmarks) flag(context, x(time));
  if (hover !== null) {
    context.fillStyle = color("quiet");
    context.fillRect(x(hover) - 0.5, TOP - 2, 1, BAR + 4);
  }
  head(context, x(position), color("text"));
}

/**
 * Draws counts of messages in equal parts of the seconds `counted`, a column of pixels as strong as the
 * part of it with most messages.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {number[]} counts
 * @param {{x: (time: number) => number, counted: Range, range: Range, top: number, height: number, color: string}} strip
 */
export function bars(context, counts, { x, counted, range, top, height, color }) {
  const most = Math.max(...counts, 0);
  if (!most) return;
  context.fillStyle = color;
  const [from, to] = [Math.floor(x(range[0])), Math.ceil(x(range[1]))];
  const each = (to - from) / (range[1] - range[0]); // pixels a second
  /** @param {number} column */
  const part = (column) => share(range[0] + (column - from) / each, counted) * counts.length;
  for (let column = from; column < to; column++) {
    const first = Math.max(0, Math.floor(part(column)));
    const end = Math.ceil(part(column + 1));
    if (end <= 0) continue;
    const last = Math.min(counts.length, Math.max(first + 1, end));
    let count = 0;
    for (let i = first; i < last; i++) count = Math.max(count, counts[i]);
    if (!count) continue;
    context.globalAlpha = 0.3 + 0.5 * (count / most);
    context.fillRect(column, top, 1, height);
  }
  context.globalAlpha = 1;
}

// The messages in memory, but for those forgotten in between.
/**
 * @param {CanvasRenderingContext2D} context
 * @param {{first: number, now: number, gap: Range | null}} past
 * @param {{x: (time: number) => number, color: (name: string) => string}} axis
 */
function drawPast(context, { first, now, gap }, { x, color }) {
  context.fillStyle = color("accent");
  context.globalAlpha = 0.3;
  context.fillRect(x(first), TOP, x(now) - x(first), BAR);
  context.globalAlpha = 1;
  if (!gap) return;
  context.fillStyle = color("line");
  context.fillRect(x(gap[0]), TOP, x(gap[1]) - x(gap[0]), BAR);
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Range} range
 * @param {{x: (time: number) => number, width: number, color: (name: string) => string, origin: number}} axis
 */
function scale(context, range, { x, width, color, origin }) {
  context.font = "11px system-ui, sans-serif";
  context.fillStyle = color("quiet");
  context.textBaseline = "top";
  context.textAlign = "center";
  const length = range[1] - range[0];
  const digits = Math.min(3, Math.max(0, Math.ceil(-Math.log10(length / 10))));
  for (const time of ticks(range[0] - origin, range[1] - origin, Math.max(2, width / PER_TICK))) {
    const text = origin ? beforeText(time, digits) : duration(time, digits);
    const half = context.measureText(text).width / 2;
    context.fillText(text, Math.min(Math.max(x(time + origin), half), width - half), TOP + BAR + 4);
  }
}

// Warnings are triangles above the bar, errors lines through it with a square head; these on top.
/**
 * @param {CanvasRenderingContext2D} context
 * @param {LoggedEvent[]} events
 * @param {{range: Range, x: (time: number) => number, color: (name: string) => string}} axis
 */
function marks(context, events, { range, x, color }) {
  const inside = events.filter(([time]) => time >= range[0] && time <= range[1]);
  context.fillStyle = color("warn");
  for (const [time, level] of inside) if (level !== "error") peak(context, x(time));
  context.fillStyle = color("error");
  for (const [time, level] of inside) {
    if (level !== "error") continue;
    context.fillRect(x(time) - 1, 0, 2, TOP + BAR);
    context.fillRect(x(time) - PEAK, 0, 2 * PEAK, TOP);
  }
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {number} x
 */
function peak(context, x) {
  context.beginPath();
  context.moveTo(x, TOP + 2);
  context.lineTo(x - PEAK - 1, 0);
  context.lineTo(x + PEAK + 1, 0);
  context.fill();
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {number} x
 */
function flag(context, x) {
  context.beginPath();
  context.moveTo(x, TOP + BAR);
  context.lineTo(x - 4, TOP + BAR + 7);
  context.lineTo(x + 4, TOP + BAR + 7);
  context.fill();
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {number} x
 * @param {string} color
 */
function head(context, x, color) {
  context.fillStyle = color;
  context.fillRect(x - 1, 0, 2, TOP + BAR + 3);
  context.beginPath();
  context.arc(x, TOP + BAR / 2, 5, 0, 2 * Math.PI);
  context.fill();
}
