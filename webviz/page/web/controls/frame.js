// A frame: one of those there are, or any name.

import { set } from "../dom.js";
import { watch } from "../stores.js";
import { combobox } from "./combobox.js";

/** @import {Mixed} from "./mixed.js" */
/** @import {Control, ControlOptions} from "../types.js" */
/** @import {DeclaredProperty} from "../contents.js" */

export const FIXED_FRAME = "<Fixed Frame>";

/**
 * A field for a frame; see `control.js`. `isFixed`: it is the fixed frame itself.
 *
 * @param {DeclaredProperty & {isFixed?: boolean}} property
 * @param {ControlOptions} options
 * @returns {Control}
 */
export function frame({ isFixed = false, default: standard }, { label, change, refused }) {
  const first = isFixed ? [] : [{ value: FIXED_FRAME }];
  const field = combobox({
    label,
    value: String(standard ?? ""),
    options: first,
    change,
    refused,
    opened: () =>
      watch("frames", (values) => {
        const frames = values.get("frames") ?? [];
        field.update({ options: [...first, ...frames.map((value) => ({ value }))] });
      }),
  });
  return {
    element: field.element,
    focus: () => field.input.focus(),
    describe: (text) => set(field.input, { "aria-description": text }),
    update: (/** @type {string | Mixed} */ value) => field.update({ value }),
  };
}
