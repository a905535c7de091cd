// The card over the scene while one drives: the stick, and what the robot does.

import { el, set } from "webviz/dom.js";
import { signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { Stick } from "webviz/features/driving/teleop_stick.js";

/** @import {Shares} from "webviz/features/driving/teleop_keys.js" */

/**
 * Makes the card of a tool; `change()` is called when its controls are held or let go.
 *
 * @param {string} id
 * @param {() => void} change
 */
export function makeCard(id, change) {
  const facts = store(`tool:${id}`);
  const note = signal({ text: "", isRefused: false });
  const stick = new Stick(change);
  const sideways = [
    makeHold("Q", "Drive to the left", 1, change),
    makeHold("E", "Drive to the right", -1, change),
  ];
  const parts = [stick, ...sideways];
  const canGoSideways = () => Boolean(facts.get("value.lateral"));
  for (const { element } of sideways) set(element, { hidden: () => !canGoSideways() });
  return {
    element: el(
      "section",
      { class: "wv-teleop wv-card", "aria-label": "Teleop" },
      el(
        "div",
        { class: "wv-teleop-row" },
        readout(id, () => String(facts.get("value.topic.name") ?? "")),
        el(
          "div",
          { class: "wv-teleop-stick" },
          parts.map(({ element }) => element),
        ),
      ),
      el(
        "p",
        {
          class: "wv-teleop-note",
          role: "status",
          "data-level": () => (note.value.isRefused ? "warn" : null),
          hidden: () => !note.value.text,
        },
        () => note.value.text,
      ),
    ),
    /** True if the robot can, by the tool; read in effects. */
    canGoSideways: () => Number(facts.get("value.lateral")) > 0,
    /** Puts the focus where arrow keys drive. */
    focus: () => stick.element.focus({ preventScroll: true }),
    release() {
      for (const part of parts) part.release();
    },
    /** The held direction, as `share` of teleop_keys.js. */
    share: () => parts.map((part) => /** @type {Shares} */ (part.share())).reduce(added),
    /** @param {Shares} shares */
    showHeld: (shares) => stick.show(shares),
    /**
     * @param {string} text
     * @param {boolean} [isRefused]
     */
    showNote: (text, isRefused = false) => void (note.value = { text, isRefused }),
  };
}

/**
 * Speed and turn rate of the robot, and the topic that they come from.
 *
 * @param {string} id of the tool
 * @param {() => string} topic
 */
function readout(id, topic) {
  const robot = store(`driving:${id}`);
  /** @param {"speed" | "turn_rate"} key */
  const number = (key) => () => robot.get(key)?.toFixed(2).replace("-", "−") ?? "–";
  return el(
    "dl",
    { class: "wv-teleop-readout", "data-tip": () => robot.get("problem") || null },
    el("dt", {}, "Speed"),
    el("dd", {}, el("b", {}, number("speed")), el("span", {}, "m/s")),
    el("dt", {}, "Turn rate"),
    el("dd", {}, el("b", {}, number("turn_rate")), el("span", {}, "rad/s")),
    el("span", { class: "wv-teleop-topic" }, topic),
  );
}

/**
 * @param {Shares} a
 * @param {Shares} b
 * @returns {Shares}
 */
export const added = (a, b) => a.map((part, axis) => part + b[axis]);

/**
 * A button that counts while it is held.
 *
 * @param {string} key
 * @param {string} label
 * @param {number} way
 * @param {() => void} change
 */
function makeHold(key, label, way, change) {
  /** @type {number | null} */
  let pointer = null;
  /** @param {PointerEvent} event */
  const lift = (event) => {
    if (event.pointerId !== pointer) return;
    pointer = null;
    change();
  };
  const element = el(
    "button",
    {
      type: "button",
      class: "wv-icon wv-teleop-side",
      "aria-label": label,
      "data-tip": label,
      "data-key": key,
      tabindex: -1,
      /** @param {PointerEvent} event */
      onpointerdown(event) {
        if (pointer !== null || event.button !== 0) return;
        element.setPointerCapture(event.pointerId);
        pointer = event.pointerId;
        change();
      },
      onpointerup: lift,
      onpointercancel: lift,
      onlostpointercapture: lift,
      oncontextmenu: (event) => event.preventDefault(),
    },
    way > 0 ? "◀" : "▶",
  );
  return {
    element,
    release: () => (pointer = null),
    share: () => [0, pointer === null ? 0 : way, 0],
  };
}
