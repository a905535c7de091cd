// A number between two bounds: a slider, and a field beside it.

import { el, set } from "../dom.js";
import { MIXED, MIXED_TEXT } from "./mixed.js";
import { number } from "./number.js";
import { sync } from "./sync.js";
import { stepOf } from "./units.js";

/** @import {ControlOptions} from "../types.js" */
/** @import {NumberProperty} from "./units.js" */

/**
 * A slider; see `control.js`.
 *
 * @param {NumberProperty & {low: number, high: number}} property
 * @param {ControlOptions} options
 */
export function slider(property, options) {
  const { label, change, refused } = options;
  const range = el("input", {
    class: "wv-slider",
    type: "range",
    "aria-label": label,
    min: property.low,
    max: property.high,
    step: stepOf(property, 0),
  });
  const field = number(property, { ...options, label: `${label}, as a number` });
  const state = sync({
    show(value) {
      const isMixed = value === MIXED;
      set(range, { "data-mixed": isMixed, "aria-valuetext": isMixed ? MIXED_TEXT : null });
      const place = isMixed ? property.low : value;
      if (Number(range.value) !== place) range.value = String(place);
      fill();
      field.update(value);
    },
    send: change,
    refused,
  });

  // Where the value is, for the part of the track before it.
  function fill() {
    const share = (Number(range.value) - property.low) / (property.high - property.low);
    range.style.setProperty("--wv-share", `${100 * share}%`);
  }

  range.addEventListener("pointerdown", state.hold);
  range.addEventListener("input", () => {
    set(range, { "data-mixed": false, "aria-valuetext": null });
    fill();
    field.update(Number(range.value));
    state.edit(Number(range.value));
  });
  for (const name of ["pointerup", "pointercancel"]) range.addEventListener(name, state.release);

  return {
    element: el("div", { class: "wv-slide" }, range, field.element),
    focus: () => range.focus(),
    handle: field.handle,
    /** @param {string} text */
    describe(text) {
      set(range, { title: text });
      field.describe(text);
    },
    update: state.show,
  };
}
