// Dragging a panel by its tab or its head to another place.

import { takeKeysFirst } from "webviz/keys.js";
import { el } from "webviz/dom.js";
import { signal } from "webviz/signals.js";
import { targetAt } from "webviz/docks/places.js";

/** @import {Signal} from "webviz/signals.js" */
/** @import {Boxes, Target} from "webviz/docks/places.js" */

const SLACK = 6; // pixels that a click may move

const WORDS = {
  beside: "Beside the scene",
  below: "Below the scene",
  over: "Over the scene",
  tabs: "In the tabs",
};

/** @typedef {{x: number, y: number}} Point */
/**
 * @typedef {{
 *   boxes(): Boxes | null, drop(target: Target, grab: Point): void, touch: boolean,
 *   home(): string | undefined,
 * }} Options `boxes` returns null where nothing can be dropped; `grab` is where in the handle it is
 *   held; `home` is the word for where it was before it was placed
 */

/**
 * Lets a panel be dragged by an element.
 *
 * @param {HTMLElement} handle
 * @param {Options} options
 */
export function draggable(handle, options) {
  handle.addEventListener("pointerdown", (event) => {
    const { button, pointerType } = event;
    const from = /** @type {Element} */ (event.target);
    if (button !== 0 || (pointerType === "touch" && !options.touch)) return;
    if (from !== handle && from.closest("button, input, select")) return;
    follow(handle, event, options);
  });
}

/**
 * @param {HTMLElement} handle
 * @param {PointerEvent} start
 * @param {Options} options
 */
function follow(handle, { clientX, clientY, pointerId }, { boxes, drop, home }) {
  const corner = handle.getBoundingClientRect();
  const grab = { x: clientX - corner.left, y: clientY - corner.top };
  /** @type {Boxes | null} */
  let all = null;
  const target = signal(/** @type {Target | null} */ (null));
  const preview = previewOf(target, grab, home());

  /** @param {PointerEvent} event */
  function move(event) {
    if (event.pointerId !== pointerId) return;
    if (!all) {
      const isFar = Math.hypot(event.clientX - clientX, event.clientY - clientY) > SLACK;
      if (!isFar || !(all = boxes())) return;
      document.getElementById("webviz")?.append(preview);
    }
    target.value = targetAt(event.clientX, event.clientY, all);
  }

  /** @param {PointerEvent} event */
  function up(event) {
    if (event.pointerId !== pointerId) return;
    end();
    if (all) window.addEventListener("click", swallow, { capture: true, once: true });
    setTimeout(() => window.removeEventListener("click", swallow, { capture: true }));
    if (event.type === "pointerup" && target.value) drop(target.value, grab);
  }

  const endKeys = takeKeysFirst((event) => {
    if (event.key !== "Escape" || !all) return false;
    end();
    return true;
  });

  function end() {
    preview.remove();
    window.removeEventListener("pointermove", move);
    window.removeEventListener("pointerup", up);
    window.removeEventListener("pointercancel", up);
    endKeys();
  }

  window.addEventListener("pointermove", move);
  window.addEventListener("pointerup", up);
  window.addEventListener("pointercancel", up);
}

/**
 * The place that a panel would cover.
 *
 * @param {Signal<Target | null>} target
 * @param {Point} grab
 * @param {string} [home]
 */
function previewOf(target, grab, home = WORDS.tabs) {
  const style = () => {
    if (!target.value) return "";
    const { box, place } = target.value;
    const shift = place === "over" ? grab : { x: 0, y: 0 };
    return [
      `left: ${box.left - shift.x}px; top: ${box.top - shift.y}px`,
      `width: ${box.width}px; height: ${box.height}px`,
    ].join("; ");
  };
  /** @param {Target} target */
  const words = ({ into, place }) => {
    if (into !== undefined) return "As a tab here";
    return place === "tabs" ? home : WORDS[place];
  };
  return el(
    "div",
    { class: "wv-dock-drop", hidden: () => !target.value, style },
    el("span", {}, () => (target.value ? words(target.value) : "")),
  );
}

/** @param {Event} event */
function swallow(event) {
  event.preventDefault();
  event.stopPropagation();
}
