// Controls that the browser has by itself: a check box, a list to choose from, a line of text.

import { el, set } from "../dom.js";
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
export function checkbox(_, { label, change, refused }) {
  const input = el("input", { class: "wv-check", type: "checkbox", "aria-label": label });
  const state = sync({
    show(value) {
      input.indeterminate = value === MIXED;
      if (input.checked !== (value === true)) input.checked = value === true;
    },
    send: change,
    refused,
  });
  input.addEventListener("change", () => state.edit(input.checked));
  return {
    element: input,
    focus: () => input.focus(),
    describe: (text) => set(input, { title: text }),
    update: state.show,
  };
}

/**
 * One of a few values; see `control.js`.
 *
 * @param {DeclaredProperty} property
 * @param {ControlOptions} options
 * @returns {Control}
 */
export function choice({ choices = [] }, { label, change, refused }) {
  const select = el("select", { class: "wv-field", "aria-label": label });
  const mixed = el("option", { hidden: true }, MIXED_TEXT);
  let offered = choices;

  /** @param {unknown[]} values */
  function offer(values) {
    offered = values;
    select.replaceChildren(
      ...values.map((value, index) => el("option", { value: index }, String(value))),
    );
  }

  const state = sync({
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
    send: change,
    refused,
  });
  select.addEventListener("change", () => state.edit(offered[select.selectedIndex]));
  offer(choices);
  return {
    element: el("div", { class: "wv-choice" }, select, icon("chevron", 12)),
    focus: () => select.focus(),
    describe: (text) => set(select, { title: text }),
    update: state.show,
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
