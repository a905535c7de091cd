// Dragging a panel by its tab or its head to another place.

import { el, setText } from "../dom.js";
import { targetAt } from "./places.js";

/** @import {Boxes, Target} from "./places.js" */

const SLACK = 6; // pixels that a click may move

const WORDS = {
  beside: "Beside the scene",
  below: "Below the scene",
  over: "Over the scene",
  tabs: "Back to the tabs",
};

/**
 * Lets a panel be dragged by an element.
 *
 * @param {HTMLElement} handle
 * @param {{
 *   boxes(): Boxes | null, drop(target: Target, grab: {x: number, y: number}): void, touch: boolean,
 * }} options `boxes` returns null where nothing can be dropped; `grab` is where in the handle it is
 *   held
 */
export function draggable(handle, { boxes, drop, touch }) {
  handle.addEventListener("pointerdown", (event) => {
    const { button, pointerType, clientX, clientY, pointerId } = event;
    const from = /** @type {Element} */ (event.target);
    if (button !== 0 || (pointerType === "touch" && !touch)) return;
    if (from !== handle && from.closest("button, input, select")) return;
    const corner = handle.getBoundingClientRect();
    const grab = { x: clientX - corner.left, y: clientY - corner.top };
    /** @type {Boxes | null} */
    let all = null;
    /** @type {Target | null} */
    let target = null;
    const label = el("span");
    const preview = el("div", { class: "wv-drop", hidden: true }, label);

    /** @param {PointerEvent} event */
    function move(event) {
      if (event.pointerId !== pointerId) return;
      const isFar = Math.hypot(event.clientX - clientX, event.clientY - clientY) > SLACK;
      if (!all) {
        if (!isFar || !(all = boxes())) return;
        document.getElementById("webviz")?.append(preview);
      }
      target = targetAt(event.clientX, event.clientY, all);
      preview.hidden = !target;
      if (!target) return;
      const { box, place } = target;
      const shift = place === "over" ? grab : { x: 0, y: 0 };
      setText(label, WORDS[place]);
      preview.style.left = `${box.left - shift.x}px`;
      preview.style.top = `${box.top - shift.y}px`;
      preview.style.width = `${box.width}px`;
      preview.style.height = `${box.height}px`;
    }

    /** @param {PointerEvent} event */
    function up(event) {
      if (event.pointerId !== pointerId) return;
      const dropped = event.type === "pointerup" ? target : null;
      const isDragged = all !== null;
      end();
      if (isDragged) window.addEventListener("click", swallow, { capture: true, once: true });
      setTimeout(() => window.removeEventListener("click", swallow, { capture: true }));
      if (dropped) drop(dropped, grab);
    }

    /** @param {KeyboardEvent} event */
    function key(event) {
      if (event.key !== "Escape" || !all) return;
      event.stopPropagation();
      end();
    }

    function end() {
      preview.remove();
      window.removeEventListener("pointermove", move);
      window.removeEventListener("pointerup", up);
      window.removeEventListener("pointercancel", up);
      window.removeEventListener("keydown", key, { capture: true });
    }

    window.addEventListener("pointermove", move);
    window.addEventListener("pointerup", up);
    window.addEventListener("pointercancel", up);
    window.addEventListener("keydown", key, { capture: true });
  });
}

/** @param {Event} event */
function swallow(event) {
  event.preventDefault();
  event.stopPropagation();
}
