// A number between two bounds: a slider, and a field beside it.

import { el } from "webviz/dom.js";
import { effect, signal } from "webviz/signals.js";
import { MIXED, MIXED_TEXT } from "webviz/controls/mixed.js";
import { number } from "webviz/controls/number.js";
import { sync } from "webviz/controls/sync.js";
import { stepOf } from "webviz/controls/units.js";

/** @import {Mixed} from "webviz/controls/mixed.js" */
/** @import {NumberOptions} from "webviz/controls/number.js" */
/** @import {NumberProperty} from "webviz/controls/units.js" */

/**
 * A slider; see `control.js`.
 *
 * @param {NumberProperty & {low: number, high: number}} property
 * @param {NumberOptions} options
 */
export function slider(property, options) {
  const { low, high } = property;
  const current = signal(/** @type {number | Mixed | undefined} */ (undefined));
  const isMixed = () => current.value === MIXED;
  const state = sync({
    ...options,
    /** @param {number | Mixed} value */
    show: (value) => (current.value = value),
  });
  /** @type {HTMLInputElement} */
  const range = el("input", {
    class: "wv-slider",
    type: "range",
    "aria-label": options.label,
    title: options.help,
    min: low,
    max: high,
    step: stepOf(property, 0),
    "data-mixed": isMixed,
    "aria-valuetext": () => (isMixed() ? MIXED_TEXT : null),
    onpointerdown: state.hold,
    onpointerup: state.release,
    onpointercancel: state.release,
    oninput: () => state.edit((current.value = Number(range.value))),
  });
  effect(() => {
    const place = isMixed() ? low : Number(current.value ?? low);
    if (Number(range.value) !== place) range.value = String(place);
    // Where the value is, for the part of the track before it.
    const share = (Number(range.value) - low) / (high - low);
    range.style.setProperty("--wv-share", `${100 * share}%`);
  });
  const field = number(property, {
    ...options,
    label: `${options.label}, as a number`,
    value: () => current.value,
  });
  return {
    element: el("div", { class: "wv-slide" }, range, field.element),
    focus: () => range.focus(),
    handle: field.handle,
  };
}
