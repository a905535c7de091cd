// The list below a combobox, over everything else.

import { el, newId, set } from "webviz/dom.js";
import { effect, owned, untracked } from "webviz/signals.js";
import { wordsOf } from "webviz/words.js";

/** @import {Choice} from "webviz/types.js" */
/** @import {Mixed} from "webviz/controls/mixed.js" */
/** @import {Readable, Signal} from "webviz/signals.js" */

const MAX_SHOWN = 100;

/**
 * A list of options for an input that is its combobox, there while `isOpen`; `choose` is called with
 * the value picked, which may be the text as it was typed if that is `free`.
 *
 * @param {HTMLInputElement} input
 * @param {string} label
 * @param {{
 *   isOpen: Signal<boolean>, options: Readable<Choice[]>, free: boolean,
 *   choose: (value: string) => void,
 * }} options
 */
export function listbox(input, label, { isOpen, options, free, choose }) {
  const id = newId("list");
  // In the top layer, where neither the panel's edge nor a dialog cuts it off.
  const element = el("div", {
    id,
    class: "wv-list",
    role: "listbox",
    "aria-label": label,
    popover: "manual",
    onpointerdown: (event) => event.preventDefault(), // the field keeps the focus
  });
  set(input, { "aria-controls": id, "aria-expanded": () => String(isOpen.value) });
  /** @type {Choice[]} */
  let shown = [];
  let search = "";
  let active = -1;

  function fill() {
    const chosen = shown[active]?.value;
    const words = wordsOf(search);
    const matches = options.value.filter((one) => fits(one, words));
    shown = matches.slice(0, MAX_SHOWN);
    const typed = search.trim();
    // Enter takes what is marked: the text itself is still to be had.
    const marked = typed ? shown[likely(typed)] : undefined;
    if (free && marked && textOf(marked) !== typed)
      shown.push({ value: typed, label: `“${typed}”`, note: "as typed" });
    active = shown.findIndex(({ value }) => value === chosen);
    const rest = matches.length - MAX_SHOWN;
    const note = rest > 0 ? `${rest} more. Type to search.` : shown.length ? "" : "No match.";
    element.replaceChildren(
      ...shown.map(item),
      ...(note ? [el("div", { class: "wv-list-more" }, note)] : []),
    );
    mark();
  }

  /**
   * @param {Choice} choice
   * @param {number} index
   */
  function item({ value, label: text, note, level }, index) {
    const name = el("span", { class: "wv-list-name" }, (text ?? value) || "(none)");
    return el(
      "div",
      {
        id: `${id}-${index}`,
        class: "wv-option",
        role: "option",
        "aria-selected": "false",
        onclick: () => choose(value),
      },
      name,
      note ? el("span", { class: "wv-list-note", "data-level": level }, note) : null,
    );
  }

  /**
   * The option of that text, or the first that begins with it; -1 for none.
   *
   * @param {string} text
   */
  function likely(text) {
    const exact = shown.findIndex((one) => textOf(one) === text);
    if (exact >= 0) return exact;
    return shown.findIndex((one) => textOf(one).toLowerCase().startsWith(text.toLowerCase()));
  }

  function mark() {
    shown.forEach((_, index) => {
      set(element.children[index], { "aria-selected": String(index === active) });
    });
    set(input, { "aria-activedescendant": active < 0 ? null : `${id}-${active}` });
    if (active >= 0) element.children[active].scrollIntoView({ block: "nearest" });
  }

  function place() {
    if (!input.isConnected) return void (isOpen.value = false);
    const field = input.getBoundingClientRect();
    const below = innerHeight - field.bottom - 8;
    const isAbove = below < 160 && field.top > below;
    element.style.minWidth = `${field.width}px`;
    element.style.maxHeight = `${Math.min(320, isAbove ? field.top - 8 : below)}px`;
    element.style.left = `${Math.max(4, Math.min(field.left, innerWidth - element.offsetWidth - 4))}px`;
    element.style.top = isAbove ? "auto" : `${field.bottom + 2}px`;
    element.style.bottom = isAbove ? `${innerHeight - field.top + 2}px` : "auto";
  }

  effect(() => {
    if (!isOpen.value) return;
    element.showPopover();
    addEventListener("scroll", place, true);
    addEventListener("resize", place);
    owned(() => {
      if (element.isConnected) element.hidePopover();
      set(input, { "aria-activedescendant": null });
      removeEventListener("scroll", place, true);
      removeEventListener("resize", place);
    });
  });
  effect(() => {
    if (!isOpen.value) return;
    fill();
    untracked(place);
  });

  return {
    element,
    /**
     * Shows the options that fit a text, with the first that begins with it marked, or the value.
     *
     * @param {string | Mixed | null} value
     * @param {string} [text]
     */
    open(value, text = "") {
      search = text;
      isOpen.value = true;
      fill();
      active = text.trim() ? likely(text.trim()) : shown.findIndex((one) => one.value === value);
      place();
      mark();
    },
    /** @param {number} by */
    move(by) {
      if (!shown.length) return;
      const last = shown.length - 1;
      const next = active + by;
      if (Math.abs(by) === 1) active = next < 0 ? last : next > last ? 0 : next;
      else active = Math.max(0, Math.min(last, next));
      mark();
    },
    /** The option that the arrow keys have come to, and the first that fits. */
    active: () => shown[active] ?? null,
    first: () => shown[0] ?? null,
  };
}

/** @param {Choice} choice */
const textOf = ({ value, label }) => label ?? value;

/**
 * @param {Choice} choice
 * @param {string[]} words
 */
function fits({ value, label }, words) {
  const text = `${value} ${label ?? ""}`.toLowerCase();
  return words.every((word) => text.includes(word));
}
