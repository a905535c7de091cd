// The card over the scene while one drives: the stick, and what the robot does.

import { el, set, setText } from "webviz/dom.js";
import { makeStick } from "webviz/features/driving/teleop_stick.js";

/** @import {Shares} from "webviz/features/driving/teleop_keys.js" */
/** @import {ValuesOf} from "webviz/types.js" */

/**
 * Makes the card; `change()` is called when its controls are held or let go.
 *
 * @param {() => void} change
 */
export function makeCard(change) {
  const stick = makeStick(change);
  const sideways = [
    makeHold("Q", "Drive to the left", 1, change),
    makeHold("E", "Drive to the right", -1, change),
  ];
  const speed = el("b");
  const turnRate = el("b");
  const topic = el("span", { class: "wv-teleop-topic" });
  const note = el("p", { class: "wv-teleop-note", role: "status" });
  const [left, right] = sideways.map(({ element }) => element);
  const readout = el(
    "dl",
    { class: "wv-teleop-readout" },
    el("dt", {}, "Speed"),
    el("dd", {}, speed, el("span", {}, "m/s")),
    el("dt", {}, "Turn rate"),
    el("dd", {}, turnRate, el("span", {}, "rad/s")),
    topic,
  );
  const element = el(
    "section",
    { class: "wv-teleop wv-card", "aria-label": "Teleop" },
    el(
      "div",
      { class: "wv-teleop-row" },
      readout,
      el("div", { class: "wv-teleop-stick" }, stick.element, left, right),
    ),
    note,
  );
  const parts = [stick, ...sideways];
  return {
    element,
    /** Puts the focus where arrow keys drive. */
    focus: () => stick.element.focus({ preventScroll: true }),
    release() {
      for (const part of parts) part.release();
    },
    /** The held direction, as `share` of teleop_keys.js. */
    share: () => parts.map((part) => /** @type {Shares} */ (part.share())).reduce(added),
    showHeld: stick.show,
    /** @param {ValuesOf<"driving"> | null} values null while nothing is known */
    showRobot(values) {
      /** @type {[HTMLElement, "speed" | "turn_rate"][]} */
      const shown = [
        [speed, "speed"],
        [turnRate, "turn_rate"],
      ];
      for (const [output, key] of shown) {
        setText(output, values?.get(key)?.toFixed(2).replace("-", "−") ?? "–");
      }
      const problem = values?.get("problem") || null;
      set(readout, { "data-tip": problem });
    },
    /** @param {ValuesOf<"tool">} values */
    showTool(values) {
      setText(topic, String(values.get("value.topic.name") ?? ""));
      for (const button of [left, right]) button.hidden = !values.get("value.lateral");
    },
    /**
     * @param {string} text
     * @param {boolean} [isRefused]
     */
    showNote(text, isRefused) {
      setText(note, text);
      set(note, { "data-level": isRefused ? "warn" : null });
      if (note.hidden !== (text === "")) note.hidden = text === "";
    },
  };
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
