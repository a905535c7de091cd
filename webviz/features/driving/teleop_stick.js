// A stick on the screen, for mouse, pen and finger: up is ahead, to the side turns.

import { el, set } from "webviz/dom.js";

/** @import {Shares} from "webviz/features/driving/teleop_keys.js" */
/** @import {Vec2} from "webviz/types.js" */

const DEAD = 0.08;

/**
 * Makes a stick; `change()` is called when it moves.
 *
 * @param {() => void} change
 */
export function makeStick(change) {
  const knob = el("div", { class: "wv-stick-knob" });
  const element = el(
    "div",
    {
      class: "wv-stick",
      role: "application",
      tabindex: 0,
      "aria-label": "Drive: hold W A S D or arrow keys, or drag",
      onpointerdown: press,
      onpointermove: move,
      onpointerup: lift,
      onpointercancel: lift,
      onlostpointercapture: lift,
      oncontextmenu: (event) => event.preventDefault(),
    },
    knob,
  );
  /** @type {number | null} */
  let pointer = null;
  /** @type {Vec2} */
  let at = [0, 0]; // to the right and up, within a circle of radius 1

  /** @param {PointerEvent} event */
  function press(event) {
    if (pointer !== null || event.button !== 0) return;
    event.preventDefault();
    element.focus({ preventScroll: true });
    element.setPointerCapture(event.pointerId);
    pointer = event.pointerId;
    move(event);
  }

  /** @param {PointerEvent} event */
  function move(event) {
    if (event.pointerId !== pointer) return;
    const { left, top, width, height } = element.getBoundingClientRect();
    const reach = (width - knob.offsetWidth) / 2;
    const [x, y] = [event.clientX - left - width / 2, top + height / 2 - event.clientY];
    const far = Math.hypot(x, y) / reach;
    const size = Math.min(1, far) < DEAD ? 0 : Math.min(1, 1 / far) / reach;
    at = [x * size, y * size];
    change();
  }

  /** @param {PointerEvent} event */
  function lift(event) {
    if (event.pointerId !== pointer) return;
    release();
    change();
  }

  function release() {
    pointer = null;
    at = [0, 0];
  }

  return {
    element,
    release,
    /** The held stick, as `share` of teleop_keys.js. */
    share: () => [at[1], 0, -at[0]],
    /**
     * Shows what is held, by whatever.
     *
     * @param {Shares} held
     */
    show([linear, , angular]) {
      const size = 1 / Math.max(1, Math.hypot(linear, angular));
      for (const [name, part] of Object.entries({ "--wv-x": -angular, "--wv-y": -linear })) {
        const place = (part * size).toFixed(3);
        if (knob.style.getPropertyValue(name) !== place) knob.style.setProperty(name, place);
      }
      set(element, { "data-held": linear !== 0 || angular !== 0 });
    },
  };
}
