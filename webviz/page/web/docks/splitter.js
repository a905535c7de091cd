// A border between two things, to be dragged or moved by arrow keys.

import { el } from "webviz/dom.js";

/**
 * `move(pixels, before)` is called with the distance from where the drag began and the `size()` then,
 * `end()` after it; an arrow key moves it by `step` pixels.
 *
 * @param {{
 *   label: string, along(): "x" | "y", size(): number, move(pixels: number, before: number): void,
 *   end(): void, step?: number, class?: string, ondblclick?: () => void, "data-tip"?: string,
 * }} options
 * @returns {HTMLElement}
 */
export function splitter({ label, along, size, move, end, step = 16, ...attributes }) {
  const isAcross = () => along() === "x";
  let [start, before] = [0, 0];
  /** @param {PointerEvent} event */
  const at = (event) => (isAcross() ? event.clientX : event.clientY);
  /** @param {KeyboardEvent} event */
  const press = (event) => {
    const keys = isAcross() ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
    const change = { [keys[0]]: -step, [keys[1]]: step }[event.key];
    if (!change) return;
    event.preventDefault();
    event.stopPropagation(); // viser's camera turns by them
    move(change, size());
    end();
  };
  /** @type {HTMLElement} */
  const bar = el("div", {
    class: `wv-splitter wv-splitter-${along()}`,
    role: "separator",
    tabindex: 0,
    "aria-orientation": isAcross() ? "vertical" : "horizontal",
    "aria-label": label,
    onkeydown: press,
    onpointerdown: (event) => {
      bar.setPointerCapture(event.pointerId);
      [start, before] = [at(event), size()];
    },
    onpointermove: (event) =>
      bar.hasPointerCapture(event.pointerId) && move(at(event) - start, before),
    onpointerup: end,
    ...attributes,
  });
  return bar;
}
