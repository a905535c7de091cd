// Two or three numbers.

import { el } from "webviz/dom.js";
import { number } from "webviz/controls/number.js";

/** @import {Mixed} from "webviz/controls/mixed.js" */
/** @import {Control, ControlOptions} from "webviz/types.js" */
/** @import {DeclaredProperty} from "webviz/contents.js" */

const AXES = ["X", "Y", "Z"];

/**
 * A vector; see `control.js`.
 *
 * @param {DeclaredProperty} property
 * @param {ControlOptions<(number | Mixed)[]>} options
 * @returns {Control}
 */
export function vector(property, { label, help, value, change, refused }) {
  let current = /** @type {(number | Mixed)[]} */ (property.default);
  /** @type {Map<number, string>} */
  const refusals = new Map();
  const parts = current.map((_, index) =>
    number(property, {
      label: `${label} ${AXES[index]}`,
      prefix: AXES[index],
      help,
      value() {
        current = value() ?? current;
        return current[index];
      },
      /** @param {number | Mixed} value */
      change(value) {
        current = current.with(index, value);
        return change(current);
      },
      /** @param {string} text */
      refused(text) {
        refusals.set(index, text);
        refused([...refusals.values()].find(Boolean) ?? "");
      },
    }),
  );
  return {
    element: el(
      "div",
      { class: "wv-vector" },
      parts.map(({ element }) => element),
    ),
    focus: () => parts[0].focus(),
  };
}
