// Text fields: input counts on Enter, or when the field is left; Escape goes back.

import { set } from "webviz/dom.js";
import { MIXED, MIXED_TEXT } from "webviz/controls/mixed.js";
import { sync } from "webviz/controls/sync.js";

/** @import {Mixed} from "webviz/controls/mixed.js" */

const MAX_TEXT = 100_000;

/**
 * Makes an input or a text area a control, see `control.js`. `encode(value)` is the text for a value;
 * `decode(text)` the inverse, which throws a sentence if the text means nothing. `after(value)` is called
 * when the text has changed, with the value that the field stands for. Besides what all controls have, `put(value)` changes it as if typed,
 * `take()` takes over what is typed so far, and `current()` is what the field stands for.
 *
 * @template T
 * @template {HTMLInputElement | HTMLTextAreaElement} Field
 * @param {Field} field
 * @param {{
 *   value: () => T | Mixed | undefined, change(value: T): unknown, refused: (text: string) => void,
 *   encode: (value: T) => string, decode: (text: string) => T, after?: (value: T | Mixed | undefined) => void, help?: string,
 * }} options
 */
export function entry(field, { value, change, refused, encode, decode, after = () => {}, help }) {
  const isLong = field instanceof HTMLTextAreaElement;
  /** @type {T | Mixed | undefined} */
  let current;
  let isTyped = false;
  const { placeholder } = field;
  /** @param {T | Mixed | undefined} value */
  const textOf = (value) => (value === MIXED ? "" : encode(/** @type {T} */ (value)));

  set(field, { autocomplete: "off", spellcheck: "false", title: help });
  const state = sync({
    value,
    /** @param {T | Mixed} value */
    show(value) {
      current = value;
      write();
    },
    change,
    isFocused: () => field.matches(":focus"),
    /** @param {string} text */
    refused(text) {
      set(field, { "aria-invalid": text ? "true" : null });
      refused(text);
    },
  });

  function write() {
    const text = textOf(current);
    if (field.value !== text) field.value = text;
    set(field, { placeholder: current === MIXED ? MIXED_TEXT : placeholder });
    after(current);
  }

  function take() {
    isTyped = false;
    // Half a letter, as some programs leave on the clipboard, cannot be sent.
    const text = field.value.toWellFormed?.() ?? field.value;
    if (text === textOf(current) && !field.getAttribute("aria-invalid")) return state.release();
    try {
      if (text.length > MAX_TEXT) {
        const [most, got] = [MAX_TEXT, text.length].map((n) => n.toLocaleString("en"));
        throw new Error(`Not changed: expected at most ${most} characters, got ${got}.`);
      }
      const value = decode(text);
      current = value;
      state.release();
      state.edit(value);
    } catch (error) {
      state.refuse(error instanceof Error ? error.message : String(error));
    }
  }

  /** @param {T} value */
  function put(value) {
    if (value === current) return;
    current = value;
    write();
    state.edit(value);
  }

  /** @type {HTMLElement} */
  const element = field;
  element.addEventListener("input", () => {
    isTyped = true;
    state.hold();
    after(current);
  });
  element.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && (!isLong || event.ctrlKey || event.metaKey)) {
      take();
    } else if (event.key === "Escape") {
      if (!isTyped && !field.getAttribute("aria-invalid")) return;
      isTyped = false;
      state.cancel();
      write();
    } else {
      return;
    }
    if (!isLong) field.select();
    event.preventDefault();
    event.stopPropagation();
  });
  element.addEventListener("blur", () => {
    if (isTyped) take();
  });

  return {
    element,
    focus: () => field.focus(),
    current: () => current,
    isTyped: () => isTyped,
    take,
    put,
    hold: state.hold,
    release: state.release,
  };
}
