// The corner of a panel over the scene, to be dragged for another size.

import { el } from "webviz/dom.js";

/**
 * `move(width, height)` is called with pixels, `end()` after the drag.
 *
 * @param {HTMLElement} element
 * @param {{move(width: number, height: number): void, end(): void}} options
 */
export function corner(element, { move, end }) {
  /** @type {{x: number, y: number} | null} */
  let grab = null; // from the size to the pointer
  const handle = el("div", { class: "wv-docked-corner", "aria-hidden": "true" });
  handle.addEventListener("pointerdown", (event) => {
    const { offsetWidth, offsetHeight } = element;
    grab = { x: event.clientX - offsetWidth, y: event.clientY - offsetHeight };
    handle.setPointerCapture(event.pointerId);
  });
  handle.addEventListener("pointermove", (event) => {
    if (grab) move(event.clientX - grab.x, event.clientY - grab.y);
  });
  for (const over of ["pointerup", "pointercancel"])
    handle.addEventListener(over, () => {
      grab = null;
      end();
    });
  return handle;
}
