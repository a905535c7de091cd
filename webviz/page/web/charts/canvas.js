// Canvases as large as their place, at the resolution of the screen.

import { contextOf } from "webviz/dom.js";

/**
 * A canvas that fits its place, with a context in pixels of the page:
 * `{context, ratio, width, height, color}`.
 *
 * @param {HTMLCanvasElement} canvas
 */
export function fitted(canvas) {
  const ratio = devicePixelRatio || 1;
  const { clientWidth: width, clientHeight: height } = canvas;
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
  const context = contextOf(canvas);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  const style = getComputedStyle(canvas);
  return {
    context,
    ratio,
    width,
    height,
    color: (/** @type {string} */ name) => style.getPropertyValue(`--wv-${name}`),
  };
}
