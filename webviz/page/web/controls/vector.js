// Two or three numbers.

import { el } from "../dom.js";
import { number } from "./number.js";

const AXES = ["X", "Y", "Z"];

/** A vector; see `control.js`. */
export function vector(property, { label, change, refused }) {
  let current = property.default;
  let told = new Map();
  const parts = property.default.map((_, index) =>
    number(property, {
      label: `${label} ${AXES[index]}`,
      prefix: AXES[index],
      change(value) {
        current = current.with(index, value);
        return change(current);
      },
      refused(text) {
        told.set(index, text);
        refused([...told.values()].find(Boolean) ?? "");
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
    describe: (text) => parts.forEach((part) => part.describe(text)),
    update(value) {
      current = value;
      parts.forEach((part, index) => part.update(value[index]));
    },
  };
}
