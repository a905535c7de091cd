// A stick on the screen, for mouse, pen and finger: up is ahead, to the side turns.

import { el, set } from "webviz/dom.js";

/** @import {Shares} from "webviz/features/driving/teleop_keys.js" */
/** @import {Vec2} from "webviz/types.js" */

const DEAD = 0.08;

/** A stick, which calls `change()` when it moves. */
export class Stick {
  #change;
  #knob = el("div", { class: "wv-stick-knob" });
  /** @type {number | null} */
  #pointer = null;
  /** @type {Vec2} */
  #at = [0, 0]; // to the right and up, within a circle of radius 1

  /** @param {() => void} change */
  constructor(change) {
    this.#change = change;
    const lift = (/** @type {PointerEvent} */ event) => this.#lift(event);
    this.element = el(
      "div",
      {
        class: "wv-stick",
        role: "application",
        tabindex: 0,
        "aria-label": "Drive: hold W A S D or arrow keys, or drag",
        onpointerdown: (event) => this.#press(event),
        onpointermove: (event) => this.#move(event),
        onpointerup: lift,
        onpointercancel: lift,
        onlostpointercapture: lift,
        oncontextmenu: (event) => event.preventDefault(),
      },
      this.#knob,
    );
  }

  /** @param {PointerEvent} event */
  #press(event) {
    if (this.#pointer !== null || event.button !== 0) return;
    event.preventDefault();
    this.element.focus({ preventScroll: true });
    this.element.setPointerCapture(event.pointerId);
    this.#pointer = event.pointerId;
    this.#move(event);
  }

  /** @param {PointerEvent} event */
  #move(event) {
    if (event.pointerId !== this.#pointer) return;
    const { left, top, width, height } = this.element.getBoundingClientRect();
    const reach = (width - this.#knob.offsetWidth) / 2;
    const [x, y] = [event.clientX - left - width / 2, top + height / 2 - event.clientY];
    const far = Math.hypot(x, y) / reach;
    const size = Math.min(1, far) < DEAD ? 0 : Math.min(1, 1 / far) / reach;
    this.#at = [x * size, y * size];
    this.#change();
  }

  /** @param {PointerEvent} event */
  #lift(event) {
    if (event.pointerId !== this.#pointer) return;
    this.release();
    this.#change();
  }

  release() {
    this.#pointer = null;
    this.#at = [0, 0];
  }

  /** The held stick, as `share` of teleop_keys.js. */
  share() {
    return [this.#at[1], 0, -this.#at[0]];
  }

  /**
   * Shows what is held, by whatever.
   *
   * @param {Shares} held
   */
  show([linear, , angular]) {
    const size = 1 / Math.max(1, Math.hypot(linear, angular));
    for (const [name, part] of Object.entries({ "--wv-x": -angular, "--wv-y": -linear })) {
      const place = (part * size).toFixed(3);
      const { style } = this.#knob;
      if (style.getPropertyValue(name) !== place) style.setProperty(name, place);
    }
    set(this.element, { "data-held": linear !== 0 || angular !== 0 });
  }
}
