// Gestures over the curves of a chart, which read out, pan, and zoom by the wheel, a box and keys.

import { shortcuts, takeKeysOf } from "webviz/keys.js";
import { el } from "webviz/dom.js";
import { boxBetween, boxed, panned, scaled, shareOf } from "webviz/charts/zoom.js";

/** @import {Area, Vec2} from "webviz/types.js" */
/** @import {AxisRanges, Zoom} from "webviz/charts/zoom.js" */

const WHEEL = 1.2;
const CLICK_PX = 3;
const UP_PX = 20; // of a drag, from which on it moves values, too

/**
 * @typedef {{
 *   ranges: () => AxisRanges, zoom: () => Zoom | null, setZoom: (zoom: Zoom | null) => void, pause: () => void,
 * }} Zoomed
 */

/** @param {{move?: number, by?: number}} step */
const zooming =
  (step) =>
  (/** @type {Zoomed} */ { ranges, zoom, setZoom }) =>
    setZoom(scaled(ranges(), zoom(), step, false));

/** @type {ReturnType<typeof shortcuts<Zoomed>>} */
const takeKey = shortcuts("Plot", [
  { does: "Zoom", keys: ["Wheel"] },
  { does: "Zoom", keys: ["+"], run: zooming({ by: 1 / WHEEL }) },
  { does: "Zoom", keys: ["-"], run: zooming({ by: WHEEL }) },
  { does: "Move in time", keys: ["ArrowLeft"], run: zooming({ move: -0.1 }) },
  { does: "Move in time", keys: ["ArrowRight"], run: zooming({ move: 0.1 }) },
  { does: "Pause", keys: [" "], run: ({ pause }) => pause() },
  {
    does: "Show all of it",
    keys: ["Escape"],
    run: ({ zoom, setZoom }) => (zoom() ? setZoom(null) : false),
  },
]);

/**
 * Listens to gestures over a canvas; returns the element of the box that is dragged.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {Zoomed & {area: () => Area, point: (share: number | null) => void}} chart `point` gets the share of the time axis left of the pointer, null when it is not over it
 */
export function listenToGestures(canvas, { area, ranges, zoom, setZoom, point, pause }) {
  /** @type {{from: Vec2, ranges: AxisRanges, isBox: boolean, isFar: boolean} | null} */
  let drag = null;
  const box = el("div", { class: "wv-chart-box", hidden: true });

  /** @param {MouseEvent} event */
  function shareAt({ clientX, clientY }) {
    const { left, top } = canvas.getBoundingClientRect();
    return shareOf([clientX - left, clientY - top], area());
  }

  function end() {
    drag = null;
    box.hidden = true;
  }

  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const [x, y] = shareAt(event);
    const isValues = event.shiftKey || x < 0;
    // Browsers turn the wheel sideways with Shift.
    const by = WHEEL ** Math.sign(event.deltaY || event.deltaX);
    setZoom(scaled(ranges(), zoom(), { around: isValues ? y : x, by }, isValues));
  });
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    drag = { from: shareAt(event), ranges: ranges(), isBox: event.shiftKey, isFar: false };
  });
  canvas.addEventListener("pointermove", (event) => {
    const to = shareAt(event);
    if (!drag) return point(to[0] >= 0 && to[0] <= 1 ? to[0] : null);
    const { from } = drag;
    const { width, height } = area();
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    drag.isFar ||= Math.hypot(dx * width, dy * height) > CLICK_PX;
    if (!drag.isFar) return;
    if (!drag.isBox) {
      const isUp = zoom()?.values != null || Math.abs(dy * height) > UP_PX;
      return setZoom(panned(drag.ranges, [dx, dy], isUp));
    }
    for (const [key, pixels] of Object.entries(boxBetween(from, to, area())))
      box.style.setProperty(key, `${pixels}px`);
    box.hidden = false;
  });
  canvas.addEventListener("pointerup", (event) => {
    const zoomed = drag?.isBox && drag.isFar && boxed(drag.ranges, drag.from, shareAt(event));
    if (zoomed) setZoom(zoomed);
    end();
  });
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("pointerleave", () => point(null));
  canvas.addEventListener("dblclick", () => setZoom(null));
  takeKeysOf(canvas, (event) => takeKey({ ranges, zoom, setZoom, pause }, event));
  return box;
}
