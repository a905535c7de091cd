// Simple controls: a check box, one of a few values, a line of text.

import { el } from "webviz/dom.js";
import { combobox } from "webviz/controls/combobox.js";
import { entry } from "webviz/controls/entry.js";
import { textField } from "webviz/controls/fields.js";
import { MIXED } from "webviz/controls/mixed.js";
import { sync } from "webviz/controls/sync.js";

/** @import {Control, ControlOptions} from "webviz/types.js" */
/** @import {DeclaredProperty} from "webviz/contents.js" */

/**
 * A check box; see `control.js`.
 *
 * @param {DeclaredProperty} _
 * @param {ControlOptions} options
 * @returns {Control}
 */
export function checkbox(_, options) {
  /** @type {HTMLInputElement} */
  const input = el("input", {
    class: "wv-check",
    type: "checkbox",
    "aria-label": options.label,
    title: options.help,
    onchange: () => state.edit(input.checked),
  });
  const state = sync({
    ...options,
    show(value) {
      input.indeterminate = value === MIXED;
      input.checked = value === true;
    },
  });
  return { element: input, focus: () => input.focus() };
}

/**
 * One of a few values; see `control.js`.
 *
 * @param {DeclaredProperty} property
 * @param {ControlOptions} options
 * @returns {Control}
 */
export function choice({ choices = [] }, { value, change, ...options }) {
  // A newer version of the viewer may have a value that is unknown here.
  const isNew = () => value() !== undefined && value() !== MIXED && !choices.includes(value());
  const offered = () => (isNew() ? [...choices, value()] : choices);
  return combobox({
    ...options,
    value: () => (value() === MIXED ? MIXED : String(value() ?? "")),
    options: () => offered().map((each) => ({ value: String(each) })),
    change: (text) => change(offered().find((each) => String(each) === text)),
    free: false,
  });
}

/**
 * A line of text; see `control.js`.
 *
 * @param {DeclaredProperty} _
 * @param {ControlOptions} options
 * @returns {Control}
 */
export function text(_, options) {
  const input = textField(options.label);
  return entry(input, { ...options, encode: String, decode: (typed) => typed });
}
