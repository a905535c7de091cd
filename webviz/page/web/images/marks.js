// Figures over the picture of a pane: boxes of detections, lines, points, circles and texts.

/** @import {Mark} from "webviz/messages.js" */
/** @import {Vec2} from "webviz/types.js" */

/**
 * The places at which pixels of the picture are drawn, the size of one, and the width of the pane.
 *
 * @typedef {{at: (x: number, y: number) => Vec2, scale: number, width: number}} Places
 */

const THINNEST = 1.5; // pixels of the pane, for lines that would be hardly seen
const SMALLEST_TEXT = 9;
const LABEL_PX = 12;
const PAD = 3;
const NEAR_PX = 6;
const FONT = "system-ui, sans-serif";

/**
 * Draws marks into a 2D context; later ones lie on top, and texts above all.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Mark[]} marks
 * @param {Places} places
 */
export function drawMarks(context, marks, places) {
  context.save();
  context.lineJoin = "round";
  for (const mark of marks) drawMark(context, mark, places);
  for (const mark of marks) if (mark.text) drawText(context, mark, places);
  context.restore();
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Mark} mark
 * @param {Places} places
 */
function drawMark(context, mark, places) {
  const { kind, color, colors = [], fill = "", width = 1 } = mark;
  const spots = spotsOf(mark, places);
  const size = Math.max(width * places.scale, THINNEST);
  context.lineWidth = size;
  if (kind === "points") {
    spots.forEach(([x, y], i) => {
      context.fillStyle = colors[i] ?? color;
      context.beginPath();
      context.arc(x, y, Math.max(size / 2, 2), 0, 2 * Math.PI);
      context.fill();
    });
    return;
  }
  if (kind === "text") return;
  const outline = outlineOf(mark, spots);
  if (fill) {
    context.fillStyle = fill;
    context.fill(outline);
  }
  if (!colors.length || kind === "circle") {
    context.strokeStyle = color;
    if (width > 0) context.stroke(outline);
    return;
  }
  linesOf(mark, spots).forEach(([from, to], i) => {
    context.strokeStyle = colors[i] ?? color;
    context.beginPath();
    context.moveTo(...from);
    context.lineTo(...to);
    context.stroke();
  });
}

/**
 * A text at its place, or beside a mark on a plate of its colour.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Mark} mark
 * @param {Places} places
 */
function drawText(context, mark, places) {
  const { kind, text = "", color, fill = "", width = 1 } = mark;
  const isLabel = kind !== "text";
  const [[x, y]] = spotsOf(mark, places);
  const height = isLabel ? LABEL_PX : Math.max(width * places.scale, SMALLEST_TEXT);
  context.font = `${height}px ${FONT}`;
  context.textBaseline = "bottom";
  const plate = isLabel ? color : fill;
  const wide = context.measureText(text).width;
  // The label of a box at the edge of the pane stays inside.
  const left = isLabel ? Math.max(0, Math.min(x, places.width - wide - 2 * PAD)) : x;
  const bottom = isLabel ? Math.max(y, height + PAD) : y;
  if (plate) {
    context.fillStyle = plate;
    context.fillRect(left, bottom - height - PAD, wide + 2 * PAD, height + PAD);
  }
  context.fillStyle = isLabel ? (isLight(color) ? "#000" : "#fff") : color;
  context.fillText(text, plate ? left + PAD : left, bottom - 1);
}

/**
 * The text about the smallest mark at a place of the pane, "" without one.
 *
 * @param {Mark[]} marks
 * @param {Places} places
 * @param {Vec2} place
 */
export function markAt(marks, places, [x, y]) {
  let [about, least] = ["", Infinity];
  for (const mark of marks) {
    if (!mark.about) continue;
    const spots = spotsOf(mark, places);
    const xs = spots.map((spot) => spot[0]);
    const ys = spots.map((spot) => spot[1]);
    const [left, right] = [Math.min(...xs) - NEAR_PX, Math.max(...xs) + NEAR_PX];
    const [top, bottom] = [Math.min(...ys) - NEAR_PX, Math.max(...ys) + NEAR_PX];
    const area = (right - left) * (bottom - top);
    if (x < left || x > right || y < top || y > bottom || area >= least) continue;
    [about, least] = [mark.about, area];
  }
  return about;
}

/**
 * The places in a pane whose picture is zoomed.
 *
 * @param {Places} places without the zoom
 * @param {number} zoom
 * @param {Vec2} corner of the zoomed picture, as shares of the pane
 * @param {number} height of the pane
 * @returns {Places}
 */
export const zoomedPlaces = ({ at, scale, width }, zoom, [left, top], height) => ({
  width,
  scale: scale * zoom,
  at(x, y) {
    const [across, down] = at(x, y);
    return [left * width + zoom * across, top * height + zoom * down];
  },
});

/**
 * @param {Mark} mark
 * @param {Places} places
 */
function spotsOf({ points }, { at }) {
  /** @type {Vec2[]} */
  const spots = [];
  for (let i = 0; i + 1 < points.length; i += 2) spots.push(at(points[i], points[i + 1]));
  return spots;
}

/**
 * @param {Mark} mark
 * @param {Vec2[]} spots
 */
function outlineOf(mark, spots) {
  const outline = new Path2D();
  if (mark.kind === "circle") {
    const [[x, y], [x2, y2]] = spots;
    outline.arc(x, y, Math.hypot(x2 - x, y2 - y), 0, 2 * Math.PI);
  } else if (mark.kind === "pairs") {
    for (const [from, to] of linesOf(mark, spots)) {
      outline.moveTo(...from);
      outline.lineTo(...to);
    }
  } else {
    spots.forEach((spot) => outline.lineTo(...spot));
    if (mark.kind === "loop") outline.closePath();
  }
  return outline;
}

/**
 * The lines of a mark, each from one place to another.
 *
 * @param {Mark} mark
 * @param {Vec2[]} spots
 * @returns {[Vec2, Vec2][]}
 */
function linesOf({ kind }, spots) {
  const ends = spots.map((spot, i) => /** @type {[Vec2, Vec2]} */ ([spot, spots[i + 1]]));
  if (kind === "pairs") return ends.filter(([, to], i) => to && i % 2 === 0);
  const open = ends.slice(0, -1);
  return kind === "loop" && spots.length ? [...open, [spots[spots.length - 1], spots[0]]] : open;
}

/** @param {string} color such as "#ff0000" */
function isLight(color) {
  const [red, green, blue] = [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
  return 0.299 * red + 0.587 * green + 0.114 * blue > 140;
}
