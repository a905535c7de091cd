// A field with a list of what could be entered: searched by typing, walked through by arrow keys.

import { el, set, setText } from "../dom.js";
import { icon } from "../icons.js";
import { textField } from "./fields.js";
import { listbox } from "./listbox.js";
import { MIXED, MIXED_TEXT } from "./mixed.js";
import { sync } from "./sync.js";

/** @import {Choice} from "../types.js" */
/** @import {Mixed} from "./mixed.js" */

/**
 * A field that calls `change(value)` with what was chosen or typed.
 *
 * Options are `{value, note, label, level}`: `note` stands quietly at the right, `label` is shown in
 * place of the value, `level` colours the note. `change` may return the promise of `act`: what it
 * refuses stays in the field for correction, `refused(text)` receives the reason. Unless `free`, only options
 * are taken. `opened()` is called when the list opens, and what it returns when it closes. Returns
 * `{element, input, restore(), update({value, options})}`.
 *
 * @param {{
 *   label: string, value: string | Mixed, options: Choice[], change: (value: string) => unknown,
 *   refused?: (text: string) => void, free?: boolean, placeholder?: string,
 *   opened?: () => (() => void) | undefined,
 * }} options
 */
export function combobox({
  label,
  value,
  options,
  change,
  refused,
  free = true,
  placeholder = "",
  opened = () => undefined,
}) {
  /** @type {(() => void) | undefined} */
  let closed;
  let current = value;
  let isTyped = false; // since the list was opened or the last choice

  const input = textField(label, {
    role: "combobox",
    "aria-expanded": "false",
    "aria-autocomplete": "list",
    autocomplete: "off",
    spellcheck: "false",
    placeholder,
  });
  const note = el("span", { class: "wv-combobox-note", "aria-hidden": "true" });
  const list = listbox(input, label, choose);
  const element = el(
    "div",
    { class: "wv-combobox" },
    input,
    note,
    icon("chevron", 12),
    list.element,
  );

  /** @param {string | Mixed} wanted */
  const option = (wanted) => options.find((one) => one.value === wanted);
  /** @param {string | Mixed} wanted */
  const textOf = (wanted) => (wanted === MIXED ? "" : (option(wanted)?.label ?? wanted));
  const state = sync({
    /** @param {string | Mixed} shown */
    show(shown) {
      current = shown;
      if (!isTyped) write();
    },
    send: change,
    isFocused: () => input.matches(":focus"),
    /** @param {string} text */
    refused(text) {
      set(input, { "aria-invalid": text ? "true" : null });
      refused?.(text);
    },
  });

  function write() {
    const text = textOf(current);
    if (input.value !== text) input.value = text;
    set(input, { placeholder: current === MIXED ? MIXED_TEXT : placeholder });
    setText(note, option(current)?.note ?? "");
    set(note, { "data-level": option(current)?.level });
    set(input, { title: text.length > 24 ? text.slice(0, 1000) : null });
  }

  /** @param {string} [text] */
  function open(text) {
    const wasOpen = list.isOpen();
    if (wasOpen && text === undefined) return;
    list.open(options, text === undefined ? current : null, text);
    if (!wasOpen) closed = opened();
  }

  function close() {
    list.close();
    isTyped = false;
    closed?.();
    closed = undefined;
  }

  /** @param {string} chosen */
  function choose(chosen) {
    const isNew = chosen !== current || input.getAttribute("aria-invalid");
    close();
    current = chosen;
    write();
    state.release();
    if (isNew) state.edit(chosen);
  }

  // What was typed: an option by its text, or the text itself.
  function take() {
    const text = input.value.trim();
    const exact = options.find((one) => (one.label ?? one.value) === text);
    if (exact) choose(exact.value);
    else if (free) choose(text);
    else if (list.first()) choose(list.first().value);
    else back();
  }

  function back() {
    close();
    state.cancel();
    write();
  }

  input.addEventListener("focus", () => input.select());
  input.addEventListener("click", () => {
    if (!list.isOpen()) input.select();
    open();
  });
  input.addEventListener("input", () => {
    isTyped = true;
    state.hold();
    open(input.value);
  });
  input.addEventListener("keydown", (event) => {
    if (event.key === "Escape") {
      if (!list.isOpen() && !isTyped && !input.getAttribute("aria-invalid")) return;
      back();
      input.select();
    } else if (event.key === "Enter") {
      if (list.active()) choose(list.active().value);
      else if (isTyped) take();
      else return;
      input.select();
    } else if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      if (!list.isOpen()) open();
      else list.move(event.key === "ArrowDown" ? 1 : -1);
    } else if (list.isOpen() && (event.key === "PageDown" || event.key === "PageUp")) {
      list.move(event.key === "PageDown" ? 8 : -8);
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  });
  input.addEventListener("blur", () => {
    if (isTyped) take();
    else close();
  });

  write();
  state.show(value);
  return {
    element,
    input,
    /** Shows what the viewer has instead of what it refused. */
    restore: back,
    /** @param {{value?: string | Mixed, options?: Choice[]}} next */
    update(next) {
      if (next.options) {
        options = next.options;
        list.update(options);
      }
      state.show(next.value === undefined ? current : next.value);
    },
  };
}
