// The value of a pixel by its colour, where there is no message to read.

/** @import {ColorRange} from "webviz/messages.js" */

const DIGITS = 3; // more than the 8 bits of a picture tell
const NO_COLOR = 60; // away from all colours of a scale: black, which stands for no measurement

/**
 * Of a picture with a legend about the measurement, of others red, green and blue.
 *
 * @param {number[]} rgb
 * @param {ColorRange} [legend]
 */
export function pixelText(rgb, legend) {
  if (!legend) return `rgb ${rgb.join(" ")}`;
  const { low, high, unit, colors } = legend;
  let [nearest, share] = [Infinity, 0];
  for (let i = 0; i + 1 < colors.length; i++) {
    const way = colors[i + 1].map((each, k) => each - colors[i][k]);
    const from = rgb.map((each, k) => each - colors[i][k]);
    const along = dot(from, way) / Math.max(dot(way, way), 1);
    const part = Math.min(Math.max(along, 0), 1);
    const off = Math.hypot(...from.map((each, k) => each - part * way[k]));
    if (off < nearest) [nearest, share] = [off, (i + part) / (colors.length - 1)];
  }
  if (nearest > NO_COLOR) return "no measurement";
  const value = Number((low + share * (high - low)).toPrecision(DIGITS));
  return `≈ ${value} ${unit}`.trim();
}

/**
 * @param {number[]} a
 * @param {number[]} b
 */
const dot = (a, b) => a.reduce((sum, each, k) => sum + each * b[k], 0);
