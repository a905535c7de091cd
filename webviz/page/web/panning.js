// Drags, wheel and keys over a canvas that shows a part of something larger.

import { takeKeysOf } from "webviz/keys.js";

/**
 * Listens to a canvas. `move` gets pixels, and `click` what was no drag of `slack` pixels or more.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {{
 *   wheel: (event: WheelEvent) => void, move: (dx: number, dy: number) => void,
 *   keys: Record<string, () => void>, click?: (event: PointerEvent) => void, slack?: number,
 * }} listeners
 */
export function listenToPanning(canvas, { wheel, move, keys, click = () => {}, slack = 0 }) {
  /** @type {{x: number, y: number, isDrag: boolean} | null} */
  let press = null;
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    wheel(event);
  });
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    press = { x: event.clientX, y: event.clientY, isDrag: false };
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!press) return;
    const [dx, dy] = [event.clientX - press.x, event.clientY - press.y];
    if (!press.isDrag && Math.hypot(dx, dy) < slack) return;
    press = { x: event.clientX, y: event.clientY, isDrag: true };
    move(dx, dy);
  });
  canvas.addEventListener("pointerup", (event) => {
    if (press && !press.isDrag) click(event);
    press = null;
  });
  canvas.addEventListener("pointercancel", () => (press = null));
  takeKeysOf(canvas, (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return false;
    keys[event.key]();
    return true;
  });
}
