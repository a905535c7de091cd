// A colour: a swatch that opens the browser's own picker, and red, green and blue as text.

import { el, set } from "webviz/dom.js";
import { entry } from "webviz/controls/entry.js";
import { textField } from "webviz/controls/fields.js";

/** @import {Control, ControlOptions} from "webviz/types.js" */
/** @import {DeclaredProperty} from "webviz/contents.js" */

/** @typedef {number[]} Rgb */

/**
 * A colour of three bytes, or null if that is the default: automatic; see `control.js`.
 *
 * @param {DeclaredProperty} property
 * @param {ControlOptions<Rgb | null>} options
 * @returns {Control}
 */
export function color({ default: standard }, options) {
  const { label, help } = options;
  const isOptional = standard === null;
  const text = textField(`${label}, as text`, { placeholder: isOptional ? "automatic" : null });
  /** @type {HTMLInputElement} */
  const swatch = el("input", {
    class: "wv-swatch",
    type: "color",
    "aria-label": label,
    title: help,
    oninput: () => field.put(parse(swatch.value)),
  });
  const field = entry(text, {
    ...options,
    encode: (rgb) => rgb?.join(", ") ?? "",
    decode: (typed) => (isOptional && !typed.trim() ? null : parse(typed)),
    after: () => {
      const hex = attempt(text.value);
      if (hex && swatch.value !== hex) swatch.value = hex;
      set(swatch, { "data-automatic": isOptional && !text.value.trim() });
    },
  });
  return { ...field, element: el("div", { class: "wv-color" }, swatch, text) };
}

/**
 * "255, 0, 10", RViz's "255; 0; 10" or "#ff000a" as numbers; throws a sentence.
 *
 * @param {string} text
 */
export function parse(text) {
  const hex = /^#?([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})$/i.exec(text.trim());
  if (hex) return hex.slice(1).map((byte) => parseInt(byte, 16));
  const parts = text
    .trim()
    .replace(/^rgb\(|\)$/g, "")
    .split(/[\s,;]+/)
    .map(Number);
  const isColor =
    parts.length === 3 && parts.every((n) => Number.isInteger(n) && n >= 0 && n <= 255);
  if (!isColor) {
    throw new Error(
      "Not changed: expected red, green and blue from 0 to 255, such as 255, 128, 0.",
    );
  }
  return parts;
}

/** @param {string} text */
function attempt(text) {
  try {
    return `#${parse(text)
      .map((byte) => byte.toString(16).padStart(2, "0"))
      .join("")}`;
  } catch {
    return null;
  }
}
