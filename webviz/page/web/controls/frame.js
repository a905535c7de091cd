// A frame: one of those there are, or any name.

import { set } from "../dom.js";
import { watch } from "../stores.js";
import { combobox } from "./combobox.js";

export const FIXED_FRAME = "<Fixed Frame>";

/** A field for a frame; see `control.js`. `isFixed`: it is the fixed frame itself. */
export function frame({ isFixed = false, default: standard }, { label, change, refused }) {
  const first = isFixed ? [] : [{ value: FIXED_FRAME }];
  const field = combobox({
    label,
    value: standard ?? "",
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
    update: (value) => field.update({ value }),
  };
}
