// Text fields: input counts on Enter, or when the field is left; Escape goes back.

import { set } from "webviz/dom.js";
import { MIXED, MIXED_TEXT } from "webviz/controls/mixed.js";
import { sync } from "webviz/controls/sync.js";
import { signal } from "webviz/signals.js";

/** @import {Mixed} from "webviz/controls/mixed.js" */
/** @import {Signal} from "webviz/signals.js" */

const MAX_TEXT = 100_000;

/**
 * @template T
 * @typedef {{
 *   value: () => T | Mixed | undefined, change(value: T): unknown, refused: (text: string) => void,
 *   encode: (value: T) => string, decode: (text: string) => T, after?: () => void, help?: string,
 * }} EntryOptions
 */

/**
 * Makes an input or a text area a control, see `control.js`. `encode(value)` is the text for a value;
 * `decode(text)` the inverse, which throws a sentence if the text means nothing. `after()` is called
 * when the text has changed. Besides what all controls have, `put(value)` changes it as if typed,
 * `take()` takes over what is typed so far, and `current()` is what the field stands for, which
 * effects may read.
 *
 * @template T
 * @param {HTMLInputElement | HTMLTextAreaElement} field
 * @param {EntryOptions<T>} options
 */
export function entry(field, options) {
  const text = new Entry(field, options);
  /** @type {HTMLElement} */
  const element = field;
  element.addEventListener("input", () => text.type());
  element.addEventListener("keydown", (event) => press(field, text, event));
  element.addEventListener("blur", () => {
    if (text.isTyped) text.take();
  });
  return {
    element,
    focus: () => field.focus(),
    current: () => text.current.value,
    isTyped: () => text.isTyped,
    take: () => text.take(),
    /** @param {T} value */
    put: (value) => text.put(value),
    hold: text.state.hold,
    release: text.state.release,
  };
}

/**
 * A text that the user enters, and the value that it stands for.
 *
 * @template T
 */
class Entry {
  /** @type {Signal<T | Mixed | undefined>} */
  current = signal(/** @type {T | Mixed | undefined} */ (undefined));
  isTyped = false;
  #isInvalid = signal(false);
  #field;
  #options;

  /**
   * @param {HTMLInputElement | HTMLTextAreaElement} field
   * @param {EntryOptions<T>} options
   */
  constructor(field, options) {
    const { value, change, refused, help } = options;
    this.#field = field;
    this.#options = options;
    const { placeholder } = field;
    set(field, {
      autocomplete: "off",
      spellcheck: "false",
      title: help,
      placeholder: () => (this.current.value === MIXED ? MIXED_TEXT : placeholder),
      "aria-invalid": () => this.#isInvalid.value || null,
    });
    this.state = sync({
      value,
      show: (/** @type {T | Mixed} */ next) => this.#show(next),
      change,
      isFocused: () => field.matches(":focus"),
      refused: (text) => {
        this.#isInvalid.value = text !== "";
        refused(text);
      },
    });
  }

  type() {
    this.isTyped = true;
    this.state.hold();
    this.#options.after?.();
  }

  take() {
    this.isTyped = false;
    // Half a letter, as some programs leave on the clipboard, cannot be sent.
    const text = this.#field.value.toWellFormed?.() ?? this.#field.value;
    if (text === this.#text() && !this.isInvalid()) return this.state.release();
    try {
      if (text.length > MAX_TEXT) {
        const [most, got] = [MAX_TEXT, text.length].map((n) => n.toLocaleString("en"));
        throw new Error(`Not changed: expected at most ${most} characters, got ${got}.`);
      }
      const value = this.#options.decode(text);
      this.current.value = value;
      this.state.release();
      this.state.edit(value);
    } catch (error) {
      this.state.refuse(error instanceof Error ? error.message : String(error));
    }
  }

  /** @param {T} value */
  put(value) {
    if (value === this.current.value) return;
    this.#show(value);
    this.state.edit(value);
  }

  /** Back to what the viewer has. */
  cancel() {
    this.isTyped = false;
    this.state.cancel();
    this.#write();
  }

  /** @returns {boolean} */
  isInvalid() {
    return this.#isInvalid.value;
  }

  /** @param {T | Mixed | undefined} value */
  #show(value) {
    this.current.value = value;
    this.#write();
  }

  #text() {
    const current = this.current.value;
    return current === MIXED ? "" : this.#options.encode(/** @type {T} */ (current));
  }

  #write() {
    const text = this.#text();
    if (this.#field.value !== text) this.#field.value = text;
    this.#options.after?.();
  }
}

/**
 * Enter takes over what is typed, with Ctrl in a text of several lines; Escape goes back.
 *
 * @template T
 * @param {HTMLInputElement | HTMLTextAreaElement} field
 * @param {Entry<T>} text
 * @param {KeyboardEvent} event
 */
function press(field, text, event) {
  const isLong = field instanceof HTMLTextAreaElement;
  if (event.key === "Enter" && (!isLong || event.ctrlKey || event.metaKey)) {
    text.take();
  } else if (event.key === "Escape") {
    if (!text.isTyped && !text.isInvalid()) return;
    text.cancel();
  } else {
    return;
  }
  if (!isLong) field.select();
  event.preventDefault();
  event.stopPropagation();
}
