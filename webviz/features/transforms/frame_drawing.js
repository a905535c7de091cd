// Draws the tree of frames on a canvas: boxes in columns, and curves from parents to children.

import { ageText, factOf } from "webviz/panels/frame_rows.js";

/** @import {ValuesOf} from "webviz/types.js" */
/** @import {Frame} from "webviz/contents.js" */

/**
 * @typedef {{name: string, x: number, y: number, width: number, lines: string[], isStatic: boolean,
 *   isFaulty: boolean}} Box
 * @typedef {{from: Box, to: Box, isStatic: boolean, isFaulty: boolean}} Link
 * @typedef {{boxes: Map<string, Box>, links: Link[], width: number, height: number}} Drawing
 * @typedef {{x: number, y: number, scale: number}} Look
 */

export const HEIGHT = 52;
const ROW = 62;
const GAP = 64;
const EDGE = 16;
const PADDING = 10;
const NARROWEST = 100;
const WIDEST = 260;
const LINE = 14;
const BOLD = "600 13px ";
const PLAIN = "12px ";
const SMALLEST_TEXT = 0.3; // of the scale; below it, texts would be noise
const FONT = "system-ui, sans-serif";

/**
 * The boxes and links of a tree; `places` and `edges` are those of the store "frame_tree", `values`
 * those of "transforms".
 *
 * @param {CanvasRenderingContext2D} context
 * @param {[string, number, number][]} places
 * @param {[string, string, boolean][]} edges
 * @param {number} rows
 * @param {ValuesOf<"transforms">} values
 * @returns {Drawing}
 */
export function layOut(context, places, edges, rows, values) {
  const isSplit = (values.get("/roots") ?? []).length > 1;
  /** @type {Map<string, Box>} */
  const boxes = new Map();
  /** @type {number[]} */
  const widths = [];
  for (const [name, column, row] of places) {
    const frame = name.startsWith("/") ? undefined : values.get(name);
    const lines = frame ? factsOf(frame) : ["root"];
    context.font = BOLD + FONT;
    const wanted =
      Math.max(context.measureText(short(name)).width, lines[0].length * 6.5) + 2 * PADDING;
    const width = Math.max(NARROWEST, Math.min(wanted, WIDEST));
    widths[column] = Math.max(widths[column] ?? 0, width);
    const isFaulty = frame ? frame.problems.length > 0 : isSplit;
    const y = EDGE + row * ROW;
    boxes.set(name, {
      name,
      x: column,
      y,
      width,
      lines,
      isStatic: Boolean(frame?.is_static),
      isFaulty,
    });
  }
  const lefts = [EDGE];
  for (const width of widths) lefts.push(/** @type {number} */ (lefts.at(-1)) + width + GAP);
  for (const box of boxes.values()) [box.x, box.width] = [lefts[box.x], widths[box.x]];
  const links = edges.flatMap(([parent, child, isExtra]) => {
    const [from, to] = [boxes.get(parent), boxes.get(child)];
    if (!from || !to) return [];
    return [{ from, to, isStatic: to.isStatic, isFaulty: isExtra || to.isFaulty }];
  });
  const width = /** @type {number} */ (lefts.at(-1)) - GAP + EDGE;
  return { boxes, links, width, height: EDGE + rows * ROW };
}

/** @param {Frame} frame */
function factsOf(frame) {
  const age = frame.is_static || !frame.samples ? "" : `${ageText(frame)} old`;
  return [[factOf(frame), age].filter(Boolean).join(", "), frame.nodes.join(", ")];
}

/**
 * Draws what is in sight; `isFound` says which frames a search finds, null without one.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {Drawing} drawing
 * @param {Look} look
 * @param {((name: string) => boolean) | null} isFound
 * @param {string} chosen
 */
export function draw(canvas, drawing, { x, y, scale }, isFound, chosen) {
  const ratio = devicePixelRatio || 1;
  const { clientWidth, clientHeight } = canvas;
  const [w, h] = [Math.round(clientWidth * ratio), Math.round(clientHeight * ratio)];
  if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, w, h);
  const size = ratio * scale;
  const thinnest = 0.7 / scale;
  context.setTransform(size, 0, 0, size, -x * size, -y * size);
  const style = getComputedStyle(canvas);
  /** @param {string} name */
  const color = (name) => style.getPropertyValue(`--wv-${name}`);
  const colors = {
    accent: color("accent"),
    error: color("error"),
    line: color("line"),
    quiet: color("quiet"),
    raised: color("raised"),
    chosen: color("chosen"),
    text: color("text"),
  };
  const [right, bottom] = [x + clientWidth / scale, y + clientHeight / scale];
  for (const { from, to, isStatic, isFaulty } of drawing.links) {
    const [x1, y1] = [from.x + from.width, from.y + HEIGHT / 2];
    const [x2, y2] = [to.x, to.y + HEIGHT / 2];
    const isBelow = Math.min(y1, y2) > bottom || Math.max(y1, y2) < y;
    if (isBelow || Math.min(x1, x2) - GAP > right || Math.max(x1, x2) + GAP < x) continue;
    const bend = x2 > x1 ? GAP / 2 : GAP;
    context.strokeStyle = isFaulty ? colors.error : isStatic ? colors.quiet : colors.accent;
    context.lineWidth = Math.max(isFaulty ? 2 : 1.5, thinnest);
    context.setLineDash(isStatic ? [5, 4] : []);
    context.beginPath();
    context.moveTo(x1, y1);
    context.bezierCurveTo(x1 + bend, y1, x2 - bend, y2, x2, y2);
    context.stroke();
  }
  context.setLineDash([]);
  for (const box of drawing.boxes.values()) {
    if (box.x > right || box.x + box.width < x || box.y > bottom || box.y + HEIGHT < y) continue;
    const isHit = isFound?.(box.name);
    context.globalAlpha = isFound && !isHit ? 0.35 : 1;
    context.fillStyle = box.name === chosen || isHit ? colors.chosen : colors.raised;
    context.strokeStyle = box.isFaulty ? colors.error : isHit ? colors.accent : colors.line;
    context.lineWidth = Math.max(box.isFaulty || box.name === chosen ? 2 : 1, thinnest);
    context.beginPath();
    context.roundRect(box.x, box.y, box.width, HEIGHT, 5);
    context.fill();
    context.stroke();
    if (scale < SMALLEST_TEXT) continue;
    context.font = BOLD + FONT;
    context.fillStyle = colors.text;
    const room = box.width - 2 * PADDING;
    context.fillText(short(box.name), box.x + PADDING, box.y + 17, room);
    context.font = PLAIN + FONT;
    box.lines.forEach((line, index) => {
      context.fillStyle = box.isFaulty && !index ? colors.error : colors.quiet;
      context.fillText(short(line), box.x + PADDING, box.y + 31 + LINE * index, room);
    });
  }
  context.globalAlpha = 1;
}

/**
 * The frame at a point of the drawing, null if there is none.
 *
 * @param {Drawing} drawing
 * @param {number} x
 * @param {number} y
 */
export function boxAt(drawing, x, y) {
  for (const box of drawing.boxes.values()) {
    if (x >= box.x && x <= box.x + box.width && y >= box.y && y <= box.y + HEIGHT) return box;
  }
  return null;
}

const MAX_CHARACTERS = 40;

/**
 * A text without its middle if it is long: names differ in their ends.
 *
 * @param {string} text
 */
function short(text) {
  if (text.length <= MAX_CHARACTERS) return text;
  return `${text.slice(0, MAX_CHARACTERS / 2)}…${text.slice(1 - MAX_CHARACTERS / 2)}`;
}
