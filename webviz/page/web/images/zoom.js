// The part of a picture that a pane shows: zoomed by wheel, pinch and keys, moved by a drag.

import { shortcuts } from "webviz/keys.js";

/** @import {Vec2} from "webviz/types.js" */

const MAX_ZOOM = 32;
const WHEEL_STEP = 0.002; // per pixel of the wheel, as an exponent
const PINCH_STEP = 0.01; // pinching on a touchpad comes as small turns of the wheel with Ctrl
const LINE_PX = 16;
const KEY_STEP = 1.5;
const MOVE_STEP = 0.1; // of the pane

/** @typedef {ReturnType<typeof makeZoom>} Zoom */

/**
 * Moves by a step.
 *
 * @param {number} right
 * @param {number} down
 */
const moving = (right, down) => (/** @type {Zoom} */ zoom) =>
  zoom.moveBy([right * MOVE_STEP, down * MOVE_STEP]);

/** Takes a key of a zoomed canvas: `takeKey(zoom, event)`. @type {ReturnType<typeof shortcuts<Zoom>>} */
export const takeKey = shortcuts("Image", [
  { does: "Zoom", keys: ["Wheel"] },
  { does: "Zoom", keys: ["+"], unnamed: ["="], run: (zoom) => zoom.zoomBy(KEY_STEP) },
  { does: "Zoom", keys: ["-"], run: (zoom) => zoom.zoomBy(1 / KEY_STEP) },
  { does: "Move", keys: ["Drag"] },
  { does: "Move", keys: ["ArrowLeft"], run: moving(1, 0) },
  { does: "Move", keys: ["ArrowUp"], run: moving(0, 1) },
  { does: "Move", keys: ["ArrowRight"], run: moving(-1, 0) },
  { does: "Move", keys: ["ArrowDown"], run: moving(0, -1) },
  { does: "Show all of it", keys: ["0"], run: (zoom) => zoom.reset() },
]);

/**
 * Lets a canvas that fills its parent be zoomed; `changed()` is called whenever it shows another part.
 * Returns `{zoom(), corner(), reset(), zoomBy(factor), moveBy(shares)}`.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {() => void} changed
 */
export function makeZoom(canvas, changed) {
  let zoom = 1;
  let [x, y] = [0, 0]; // of the left upper corner, as shares of the pane

  /**
   * @param {number} nextZoom
   * @param {number} nextX
   * @param {number} nextY
   */
  function show(nextZoom, nextX, nextY) {
    zoom = Math.max(1, Math.min(nextZoom, MAX_ZOOM));
    [x, y] = [nextX, nextY].map((share) => Math.max(1 - zoom, Math.min(share, 0)));
    canvas.style.transform = zoom > 1 ? `translate(${100 * x}%, ${100 * y}%) scale(${zoom})` : "";
    canvas.classList.toggle("wv-pane-zoomed", zoom > 1);
    changed();
  }

  /**
   * Zooms by a factor; the point at a place stays there.
   *
   * @param {number} factor
   * @param {Vec2} [at]
   */
  function zoomBy(factor, [shareX, shareY] = [0.5, 0.5]) {
    const next = Math.max(1, Math.min(zoom * factor, MAX_ZOOM));
    /**
     * @param {number} share
     * @param {number} corner
     */
    const moved = (share, corner) => share - ((share - corner) * next) / zoom;
    show(next, moved(shareX, x), moved(shareY, y));
  }

  const all = {
    zoom: () => zoom,
    /** @returns {Vec2} The left upper corner of the zoomed canvas, as shares of the pane. */
    corner: () => [x, y],
    reset: () => show(1, 0, 0),
    zoomBy,
    /** @param {Vec2} shares of the pane */
    drag: ([right, down]) => show(zoom, x + right, y + down),
    /** Moves what is shown by shares of the pane; false if all of it is shown. */
    moveBy(/** @type {Vec2} */ shares) {
      if (zoom === 1) return false;
      all.drag(shares);
    },
  };
  listenToWheel(canvas, all);
  listenToFingers(canvas, all);
  return all;
}

/**
 * A point of the window as shares of the pane that a canvas fills.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {Vec2} point
 * @returns {Vec2}
 */
function shareOf(canvas, [clientX, clientY]) {
  const box = /** @type {HTMLElement} */ (canvas.parentElement).getBoundingClientRect();
  return [(clientX - box.left) / box.width, (clientY - box.top) / box.height];
}

/**
 * @param {HTMLCanvasElement} canvas
 * @param {Pick<Zoom, "zoom" | "zoomBy">} zoomed
 */
function listenToWheel(canvas, { zoom, zoomBy }) {
  canvas.addEventListener(
    "wheel",
    (event) => {
      if (zoom() === 1 && event.deltaY > 0 && !event.ctrlKey) return; // scrolls the panes
      event.preventDefault(); // with Ctrl, and by a pinch on a touchpad, it would zoom the page
      const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? 1 : LINE_PX);
      const step = event.ctrlKey ? PINCH_STEP : WHEEL_STEP;
      zoomBy(2 ** (-pixels * step), shareOf(canvas, [event.clientX, event.clientY]));
    },
    { passive: false },
  );
}

/**
 * Drags by a button or a finger, and pinches.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {Pick<Zoom, "zoom" | "zoomBy" | "drag">} zoomed
 */
function listenToFingers(canvas, { zoom, zoomBy, drag }) {
  /** @type {Map<number, Vec2>} */
  const fingers = new Map();
  // One finger on a picture that is not zoomed scrolls the panes.
  canvas.addEventListener(
    "touchmove",
    (event) => {
      if (event.touches.length > 1 || zoom() > 1) event.preventDefault();
    },
    { passive: false },
  );
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!fingers.has(event.pointerId)) return;
    const before = spread(fingers);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    const after = spread(fingers);
    const [from, to] = [shareOf(canvas, before.middle), shareOf(canvas, after.middle)];
    drag([to[0] - from[0], to[1] - from[1]]);
    if (before.size && after.size) zoomBy(after.size / before.size, to);
  });
  for (const name of /** @type {const} */ (["pointerup", "pointercancel"])) {
    canvas.addEventListener(name, (event) => fingers.delete(event.pointerId));
  }
}

/**
 * The middle of all fingers, and how far the first two are apart.
 *
 * @param {Map<number, Vec2>} fingers
 */
function spread(fingers) {
  const places = [...fingers.values()];
  /** @param {0 | 1} axis */
  const mean = (axis) => places.reduce((sum, place) => sum + place[axis], 0) / places.length;
  /** @type {Vec2} */
  const middle = [mean(0), mean(1)];
  const [first, second] = places;
  const size = second ? Math.hypot(first[0] - second[0], first[1] - second[1]) : 0;
  return { middle, size };
}
