// A field with a list of what could be entered: searched by typing, walked through by arrow keys.

import { el } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { computed, effect, signal, untracked } from "webviz/signals.js";
import { textField } from "webviz/controls/fields.js";
import { Listbox } from "webviz/controls/listbox.js";
import { MIXED, MIXED_TEXT } from "webviz/controls/mixed.js";
import { sync } from "webviz/controls/sync.js";

const CHEVRON_PX = 28;
const COARSE = matchMedia("(pointer: coarse)");

/** @import {Choice} from "webviz/types.js" */
/** @import {Mixed} from "webviz/controls/mixed.js" */
/** @import {Signal} from "webviz/signals.js" */

/**
 * @typedef {{
 *   label: string, value: () => string | Mixed, options: (isOpen: boolean) => Choice[],
 *   change: (value: string) => unknown, refused?: (text: string) => void, free?: boolean,
 *   placeholder?: string, help?: string,
 * }} ComboboxOptions
 */

/**
 * A field that calls `change(value)` with what was chosen or typed.
 *
 * `value()` and `options(isOpen)`, whether the list is open, are read in effects. Options are
 * `{value, note, label, level}`: `note` stands quietly at the right, `label` is shown in place of the
 * value, `level` colours the note. `change` may return the promise of `act`: what it refuses stays in
 * the field for correction, `refused(text)` receives the reason. Unless `free`, only options are taken.
 * Returns `{element, focus(), restore()}`.
 *
 * @param {ComboboxOptions} options
 */
export function combobox(options) {
  const box = new Combobox(options);
  return {
    element: box.element,
    focus: () => box.input.focus(),
    /** Shows what the viewer has instead of what it refused. */
    restore: () => box.restore(),
  };
}

class Combobox {
  #isOpen = signal(false);
  #isTyped = false; // since the list was opened or the last choice
  #isInvalid = signal(false);
  /** @type {Signal<string | Mixed>} */
  #current;
  /** Content of the field while the user is not typing. */
  #content = signal({ text: "", note: "", level: /** @type {string | undefined} */ (undefined) });
  #isFree;
  #options;
  #list;
  #state;

  /** @param {ComboboxOptions} options */
  constructor({ label, value, options, free = true, placeholder = "", ...rest }) {
    this.#isFree = free;
    this.#options = steady(() => options(this.#isOpen.value));
    this.#current = signal(untracked(value));
    this.input = this.#field(label, placeholder, rest.help);
    this.#list = new Listbox(this.input, label, {
      isOpen: this.#isOpen,
      options: this.#options,
      free,
      choose: (chosen) => this.#choose(chosen),
    });
    this.#state = sync({
      ...rest,
      value,
      show: (next) => this.#show(next),
      isFocused: () => this.input.matches(":focus"),
      refused: (text) => {
        this.#isInvalid.value = text !== "";
        rest.refused?.(text);
      },
    });
    effect(() => {
      if (this.#options.value && !this.#isTyped && !untracked(() => this.#isInvalid.value))
        untracked(() => this.#write());
    });
    const parts = [this.input, this.#note(), icon("chevron", 12), this.#list.element];
    this.element = el("div", { class: "wv-combobox" }, ...parts);
  }

  /** The note, which gives way to the text where there is no room for both. */
  #note() {
    const note = el(
      "span",
      {
        class: "wv-combobox-note",
        "aria-hidden": "true",
        "data-level": () => this.#content.value.level,
      },
      () => this.#content.value.note,
    );
    const { input } = this;
    effect(() => {
      const isThere = this.#content.value.note !== "";
      note.hidden = false;
      input.style.paddingRight = isThere ? `${note.offsetWidth + CHEVRON_PX}px` : "";
      note.hidden = input.scrollWidth > input.clientWidth;
    });
    return note;
  }

  restore() {
    this.#close();
    this.#state.cancel();
    this.#write();
  }

  /**
   * @param {string} label
   * @param {string} placeholder
   * @param {string} [help]
   */
  #field(label, placeholder, help) {
    const isToTap = !this.#isFree && COARSE.matches;
    /** @type {HTMLInputElement} */
    const input = textField(label, {
      role: "combobox",
      "aria-autocomplete": "list",
      "aria-description": help,
      autocomplete: "off",
      spellcheck: "false",
      inputmode: isToTap ? "none" : null, // a list to tap, without a keyboard over it
      placeholder: () => (this.#current.value === MIXED ? MIXED_TEXT : placeholder),
      title: () =>
        this.#content.value.text.length > 24 ? this.#content.value.text.slice(0, 1000) : null,
      "aria-invalid": () => this.#isInvalid.value || null,
      onfocus: () => input.select(),
      onclick: () => {
        if (!this.#isOpen.value) input.select();
        this.#open();
      },
      oninput: () => {
        this.#isTyped = true;
        this.#state.hold();
        this.#open(input.value);
      },
      onkeydown: (event) => this.#press(event),
      onblur: () => (this.#isTyped ? this.#take() : this.#close()),
    });
    return input;
  }

  /** @param {string | Mixed} value */
  #show(value) {
    this.#current.value = value;
    if (!this.#isTyped) this.#write();
  }

  #write() {
    const current = this.#current.value;
    const option = this.#options.value.find((one) => one.value === current);
    const text = current === MIXED ? "" : (option?.label ?? current);
    if (this.input.value !== text) this.#replace(text);
    this.#content.value = { text, note: option?.note ?? "", level: option?.level };
  }

  // What is typed next replaces a text that is marked as a whole, also if another comes meanwhile.
  /** @param {string} text */
  #replace(text) {
    const { input } = this;
    const { selectionStart, selectionEnd, value } = input;
    const isMarked = value && selectionStart === 0 && selectionEnd === value.length;
    input.value = text;
    if (isMarked && input.matches(":focus")) input.select();
  }

  /** @param {string} [text] */
  #open(text) {
    if (this.#isOpen.value && text === undefined) return;
    this.#list.open(text === undefined ? this.#current.value : null, text);
  }

  #close() {
    this.#isTyped = false;
    this.#isOpen.value = false;
  }

  /** @param {string} chosen */
  #choose(chosen) {
    const isNew = chosen !== this.#current.value || this.#isInvalid.value;
    this.#close();
    this.#current.value = chosen;
    this.#write();
    this.#state.release();
    if (isNew) this.#state.edit(chosen);
  }

  // What was typed: the option that is marked, or the text itself.
  #take() {
    const list = this.#list;
    const text = this.input.value.trim();
    if (list.active()) this.#choose(list.active().value);
    else if (this.#isFree) this.#choose(text);
    else if (list.first()) this.#choose(list.first().value);
    else this.restore();
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    const isOpen = this.#isOpen.value;
    const step = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 }[event.key] ?? 0;
    if (event.key === "Escape") {
      if (!isOpen && !this.#isTyped && !this.#isInvalid.value) return;
      this.restore();
      this.input.select();
    } else if (event.key === "Enter") {
      if (this.#isTyped) this.#take();
      else if (this.#list.active()) this.#choose(this.#list.active().value);
      else return;
      this.input.select();
    } else if (step && isOpen) this.#list.move(step);
    else if (Math.abs(step) === 1) this.#open();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}

/**
 * The choices, the same object as long as they are the same.
 *
 * @param {() => Choice[]} read
 */
function steady(read) {
  /** @type {Choice[]} */
  let last = [];
  return computed(() => {
    const next = read();
    if (JSON.stringify(next) !== JSON.stringify(last)) last = next;
    return last;
  });
}
