// A frame: one of those there are, or any name.

import { store } from "webviz/stores.js";
import { combobox } from "webviz/controls/combobox.js";

/** @import {Control, ControlOptions} from "webviz/types.js" */
/** @import {DeclaredProperty} from "webviz/contents.js" */
/** @import {Mixed} from "webviz/controls/mixed.js" */

export const FIXED_FRAME = "<Fixed Frame>";

const frames = store("frames");

/** The frames there are, as options of a combobox. */
export const frameOptions = () => (frames.get("frames") ?? []).map((value) => ({ value }));

/**
 * A field for a frame; see `control.js`. `isFixed`: it is the fixed frame itself.
 *
 * @param {DeclaredProperty & {isFixed?: boolean}} property
 * @param {ControlOptions<string | Mixed>} options
 * @returns {Control}
 */
export function frame({ isFixed = false, default: standard }, options) {
  const first = isFixed ? [] : [{ value: FIXED_FRAME }];
  return combobox({
    ...options,
    value: () => options.value() ?? String(standard ?? ""),
    options: (isOpen) => [...first, ...(isOpen ? frameOptions() : [])],
  });
}
