// Draws the tree of frames on a canvas: boxes in columns, and curves from parents to children.

import { contextOf } from "webviz/dom.js";
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
const THINNEST_PX = 0.7;
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
    const textWidth =
      Math.max(context.measureText(short(name)).width, lines[0].length * 6.5) + 2 * PADDING;
    const width = Math.max(NARROWEST, Math.min(textWidth, WIDEST));
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
  const { clientWidth, clientHeight } = canvas;
  const sight = { x, y, scale, right: x + clientWidth / scale, bottom: y + clientHeight / scale };
  const pen = { context: clear(canvas, sight), sight, color: colorsOf(canvas) };
  for (const link of drawing.links) drawLink(pen, link);
  pen.context.setLineDash([]);
  for (const box of drawing.boxes.values()) {
    const isHit = isFound?.(box.name) ?? false;
    pen.context.globalAlpha = isFound && !isHit ? 0.35 : 1;
    drawBox(pen, box, { isHit, isChosen: box.name === chosen });
  }
  pen.context.globalAlpha = 1;
}

/**
 * @typedef {Look & {right: number, bottom: number}} Sight
 * @typedef {{context: CanvasRenderingContext2D, sight: Sight, color: (name: string) => string}} Pen
 */

/**
 * Clears a canvas that is as large as it is shown; the context has the coordinates of the drawing.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {Look} look
 */
function clear(canvas, { x, y, scale }) {
  const ratio = devicePixelRatio || 1;
  const [w, h] = [canvas.clientWidth, canvas.clientHeight].map((each) => Math.round(each * ratio));
  if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
  const context = contextOf(canvas);
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, w, h);
  const size = ratio * scale;
  context.setTransform(size, 0, 0, size, -x * size, -y * size);
  return context;
}

/**
 * The colours of the theme by name, each asked for once.
 *
 * @param {Element} canvas
 */
function colorsOf(canvas) {
  const style = getComputedStyle(canvas);
  const names = ["accent", "error", "line", "quiet", "raised", "chosen", "text"];
  const colors = new Map(names.map((name) => [name, style.getPropertyValue(`--wv-${name}`)]));
  return (/** @type {string} */ name) => colors.get(name) ?? "";
}

/**
 * @param {Pen} pen
 * @param {Link} link
 */
function drawLink({ context, sight, color }, { from, to, isStatic, isFaulty }) {
  const [x1, y1] = [from.x + from.width, from.y + HEIGHT / 2];
  const [x2, y2] = [to.x, to.y + HEIGHT / 2];
  if (Math.min(y1, y2) > sight.bottom || Math.max(y1, y2) < sight.y) return;
  if (Math.min(x1, x2) - GAP > sight.right || Math.max(x1, x2) + GAP < sight.x) return;
  const bend = x2 > x1 ? GAP / 2 : GAP;
  context.strokeStyle = color(isFaulty ? "error" : isStatic ? "quiet" : "accent");
  context.lineWidth = Math.max(isFaulty ? 2 : 1.5, THINNEST_PX / sight.scale);
  context.setLineDash(isStatic ? [5, 4] : []);
  context.beginPath();
  context.moveTo(x1, y1);
  context.bezierCurveTo(x1 + bend, y1, x2 - bend, y2, x2, y2);
  context.stroke();
}

/**
 * @param {Pen} pen
 * @param {Box} box
 * @param {{isHit: boolean, isChosen: boolean}} state
 */
function drawBox({ context, sight, color }, box, { isHit, isChosen }) {
  if (box.x > sight.right || box.x + box.width < sight.x) return;
  if (box.y > sight.bottom || box.y + HEIGHT < sight.y) return;
  context.fillStyle = color(isChosen || isHit ? "chosen" : "raised");
  context.strokeStyle = color(box.isFaulty ? "error" : isHit ? "accent" : "line");
  context.lineWidth = Math.max(box.isFaulty || isChosen ? 2 : 1, THINNEST_PX / sight.scale);
  context.beginPath();
  context.roundRect(box.x, box.y, box.width, HEIGHT, 5);
  context.fill();
  context.stroke();
  if (sight.scale < SMALLEST_TEXT) return;
  context.font = BOLD + FONT;
  context.fillStyle = color("text");
  const room = box.width - 2 * PADDING;
  context.fillText(short(box.name), box.x + PADDING, box.y + 17, room);
  context.font = PLAIN + FONT;
  box.lines.forEach((line, index) => {
    context.fillStyle = color(box.isFaulty && !index ? "error" : "quiet");
    context.fillText(short(line), box.x + PADDING, box.y + 31 + LINE * index, room);
  });
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
