// The part of a graph that is in sight, hits in it, and texts about it. Without a document.

import { HEIGHT, namespacesOf } from "./graph_layout.js";

/** @import {Box, Drawing} from "./graph_layout.js" */

/**
 * @typedef {{x: number, y: number, scale: number}} Look the corner in sight, and how much it is enlarged
 * @typedef {{width: number, height: number}} Size
 * @typedef {(topics: Iterable<string>) => string} RateOf
 */

const FURTHEST = 0.02;
const NEAREST = 3;
const READABLE = 0.8;

/**
 * The look at a whole drawing, in the middle of a canvas.
 *
 * @param {Size} drawing
 * @param {Size} canvas
 * @returns {Look}
 */
export function whole({ width, height }, canvas) {
  const scale = Math.max(FURTHEST, Math.min(canvas.width / width, canvas.height / height, 1));
  return {
    x: (width - canvas.width / scale) / 2,
    y: (height - canvas.height / scale) / 2,
    scale,
  };
}

/**
 * The look with a box in the middle of a canvas, near enough to be read.
 *
 * @param {Look} look
 * @param {Box} box
 * @param {Size} canvas
 * @returns {Look}
 */
export function centred(look, box, canvas) {
  const scale = Math.max(look.scale, READABLE);
  return {
    x: box.x + box.width / 2 - canvas.width / scale / 2,
    y: box.y + HEIGHT / 2 - canvas.height / scale / 2,
    scale,
  };
}

/**
 * The look enlarged by a factor; what is at a pixel of the canvas stays there.
 *
 * @param {Look} look
 * @param {number} factor
 * @param {number} x
 * @param {number} y
 * @returns {Look}
 */
export function zoomed(look, factor, x, y) {
  const scale = Math.max(FURTHEST, Math.min(look.scale * factor, NEAREST));
  return { x: look.x + x / look.scale - x / scale, y: look.y + y / look.scale - y / scale, scale };
}

/**
 * The box at a pixel of the canvas.
 *
 * @param {Drawing["boxes"]} boxes
 * @param {Look} look
 * @param {number} x
 * @param {number} y
 */
export function boxAt(boxes, look, x, y) {
  const [left, top] = [look.x + x / look.scale, look.y + y / look.scale];
  return [...boxes.values()].find(
    (box) => left >= box.x && left <= box.x + box.width && top >= box.y && top <= box.y + HEIGHT,
  );
}

/**
 * A function that tells if a box, or a topic that is folded in it, has all words of a text; null without words.
 *
 * @param {string} text
 */
export function finder(text) {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  if (!words.length) return null;
  /** @param {string} name */
  const has = (name) => words.every((word) => name.toLowerCase().includes(word));
  return (/** @type {Box} */ { name, topics }) => has(name) || topics.some(has);
}

/**
 * The number of boxes, or of those that were found, and of links that do not match.
 *
 * @param {Drawing} drawing
 * @param {ReturnType<typeof finder>} isFound
 */
export function sumText({ boxes, links }, isFound) {
  if (isFound) return `${[...boxes.values()].filter(isFound).length} of ${boxes.size}`;
  const bad = links.filter(({ why }) => why).length;
  return `${boxes.size} boxes${bad ? `, ${bad} QoS mismatch${bad > 1 ? "es" : ""}` : ""}`;
}

/**
 * The highest rate, "" of none.
 *
 * @param {number[]} rates in hertz
 */
export function rateText(rates) {
  if (!rates.length) return "";
  const most = Math.max(...rates);
  return `${most >= 10 ? Math.round(most) : Number(most.toPrecision(2))} Hz`;
}

/**
 * Namespaces that can be unfolded or folded at a box, each after the text for that.
 *
 * @param {Box} box
 * @param {Set<string>} foldable
 * @param {Set<string>} opened
 * @returns {[string, string][]}
 */
export function foldsOf({ name, kind }, foldable, opened) {
  /** @type {[string, string][]} */
  const entries = kind === "group" ? [["Unfold", name]] : [];
  const inner = namespacesOf(name).findLast((each) => foldable.has(each) && opened.has(each));
  if (inner) entries.push([`Fold ${inner}`, inner]);
  return entries;
}
