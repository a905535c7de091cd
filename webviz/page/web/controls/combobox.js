// A field with a list of what could be entered: searched by typing, walked through by arrow keys.

import { el, set, setText } from "webviz/dom.js";
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

/**
 * A field that calls `change(value)` with what was chosen or typed.
 *
 * `value()` and `options(isOpen)`, whether the list is open, are read in effects. Options are
 * `{value, note, label, level}`: `note` stands quietly at the right, `label` is shown in place of the
 * value, `level` colours the note. `change` may return the promise of `act`: what it refuses stays in
 * the field for correction, `refused(text)` receives the reason. Unless `free`, only options are taken.
 * Returns `{element, focus(), restore()}`.
 *
 * @param {{
 *   label: string, value: () => string | Mixed, options: (isOpen: boolean) => Choice[],
 *   change: (value: string) => unknown, refused?: (text: string) => void, free?: boolean,
 *   placeholder?: string, help?: string,
 * }} options
 */
export function combobox({ label, value, options: read, free = true, placeholder = "", ...rest }) {
  const isOpen = signal(false);
  /** @type {Choice[]} */
  let last = [];
  const options = computed(() => {
    const next = read(isOpen.value);
    if (JSON.stringify(next) !== JSON.stringify(last)) last = next;
    return last;
  });
  let current = untracked(value);
  let isTyped = false; // since the list was opened or the last choice

  /** @type {HTMLInputElement} */
  const input = textField(label, {
    role: "combobox",
    "aria-autocomplete": "list",
    "aria-description": rest.help,
    autocomplete: "off",
    spellcheck: "false",
    inputmode: !free && COARSE.matches ? "none" : null, // a list to tap, without a keyboard over it
    placeholder,
    onfocus: () => input.select(),
    onclick() {
      if (!isOpen.value) input.select();
      open();
    },
    oninput() {
      isTyped = true;
      state.hold();
      open(input.value);
    },
    onkeydown: press,
    onblur: () => (isTyped ? take() : close()),
  });
  const note = el("span", { class: "wv-combobox-note", "aria-hidden": "true" });
  const list = new Listbox(input, label, { isOpen, options, free, choose });
  const isInvalid = () => input.getAttribute("aria-invalid") !== null;
  const state = sync({
    ...rest,
    value,
    show(shown) {
      current = shown;
      if (!isTyped) write();
    },
    isFocused: () => input.matches(":focus"),
    refused(text) {
      set(input, { "aria-invalid": text ? "true" : null });
      rest.refused?.(text);
    },
  });
  effect(() => {
    if (options.value && !isTyped && !isInvalid()) untracked(write);
  });

  function write() {
    const option = options.value.find((one) => one.value === current);
    const text = current === MIXED ? "" : (option?.label ?? current);
    if (input.value !== text) input.value = text;
    set(input, {
      placeholder: current === MIXED ? MIXED_TEXT : placeholder,
      title: text.length > 24 ? text.slice(0, 1000) : null,
    });
    setText(note, option?.note ?? "");
    set(note, { "data-level": option?.level, hidden: false });
    // A name wins over its note where there is no room for both.
    set(input, {
      style: option?.note ? `padding-right: ${note.offsetWidth + CHEVRON_PX}px` : null,
    });
    set(note, { hidden: input.scrollWidth > input.clientWidth });
  }

  /** @param {string} [text] */
  function open(text) {
    if (isOpen.value && text === undefined) return;
    list.open(text === undefined ? current : null, text);
  }

  function close() {
    isTyped = false;
    isOpen.value = false;
  }

  /** @param {string} chosen */
  function choose(chosen) {
    const isNew = chosen !== current || isInvalid();
    close();
    current = chosen;
    write();
    state.release();
    if (isNew) state.edit(chosen);
  }

  // What was typed: the option that is marked, or the text itself.
  function take() {
    const text = input.value.trim();
    if (list.active()) choose(list.active().value);
    else if (free) choose(text);
    else if (list.first()) choose(list.first().value);
    else back();
  }

  function back() {
    close();
    state.cancel();
    write();
  }

  /** @param {KeyboardEvent} event */
  function press(event) {
    const step = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 }[event.key] ?? 0;
    if (event.key === "Escape") {
      if (!isOpen.value && !isTyped && !isInvalid()) return;
      back();
      input.select();
    } else if (event.key === "Enter") {
      if (isTyped) take();
      else if (list.active()) choose(list.active().value);
      else return;
      input.select();
    } else if (step && isOpen.value) list.move(step);
    else if (Math.abs(step) === 1) open();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  return {
    element: el("div", { class: "wv-combobox" }, input, note, icon("chevron", 12), list.element),
    focus: () => input.focus(),
    /** Shows what the viewer has instead of what it refused. */
    restore: back,
  };
}
