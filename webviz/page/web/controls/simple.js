// Controls that the browser has by itself: a check box, a list to choose from, a line of text.

import { el } from "../dom.js";
import { icon } from "../icons.js";
import { entry } from "./entry.js";
import { textField } from "./fields.js";
import { MIXED, MIXED_TEXT } from "./mixed.js";
import { sync } from "./sync.js";

/** @import {Control, ControlOptions} from "../types.js" */
/** @import {DeclaredProperty} from "../contents.js" */

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
export function choice({ choices = [] }, options) {
  /** @type {HTMLSelectElement} */
  const select = el("select", {
    class: "wv-field",
    "aria-label": options.label,
    title: options.help,
    onchange: () => state.edit(offered[select.selectedIndex]),
  });
  const mixed = el("option", { hidden: true }, MIXED_TEXT);
  let offered = choices;

  /** @param {unknown[]} values */
  function offer(values) {
    offered = values;
    select.replaceChildren(
      ...values.map((value, index) => el("option", { value: index }, String(value))),
    );
  }

  offer(choices);
  const state = sync({
    ...options,
    show(value) {
      mixed.remove();
      if (value === MIXED) {
        select.append(mixed);
        mixed.selected = true;
        return;
      }
      // What a newer version of the viewer has may be unknown here.
      if (!offered.includes(value)) offer([...choices, value]);
      select.selectedIndex = offered.indexOf(value);
    },
  });
  return {
    element: el("div", { class: "wv-choice" }, select, icon("chevron", 12)),
    focus: () => select.focus(),
  };
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
