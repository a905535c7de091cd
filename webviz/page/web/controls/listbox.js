// The list below a combobox, over everything else.

import { el, newId, set } from "webviz/dom.js";
import { effect, owned, untracked } from "webviz/signals.js";
import { wordsOf } from "webviz/words.js";

/** @import {Choice} from "webviz/types.js" */
/** @import {Mixed} from "webviz/controls/mixed.js" */
/** @import {Readable, Signal} from "webviz/signals.js" */

const MAX_SHOWN = 100;

/**
 * @typedef {{
 *   isOpen: Signal<boolean>, options: Readable<Choice[]>, free: boolean,
 *   choose: (value: string) => void,
 * }} ListboxOptions
 */

/**
 * A list of options for an input that is its combobox, there while `isOpen`; `choose` is called with
 * the value picked, which may be the text as it was typed if that is `free`.
 */
export class Listbox {
  #id = newId("list");
  #input;
  #isOpen;
  #options;
  #isFree;
  #choose;
  /** @type {Choice[]} */
  #shown = [];
  #search = "";
  #active = -1;

  /**
   * @param {HTMLInputElement} input
   * @param {string} label
   * @param {ListboxOptions} options
   */
  constructor(input, label, { isOpen, options, free, choose }) {
    this.#input = input;
    this.#isOpen = isOpen;
    this.#options = options;
    this.#isFree = free;
    this.#choose = choose;
    // In the top layer, where neither the panel's edge nor a dialog cuts it off.
    this.element = el("div", {
      id: this.#id,
      class: "wv-list",
      role: "listbox",
      "aria-label": label,
      popover: "manual",
      onpointerdown: (event) => event.preventDefault(), // the field keeps the focus
    });
    set(input, { "aria-controls": this.#id, "aria-expanded": () => String(isOpen.value) });
    effect(() => {
      if (isOpen.value) this.#appear();
    });
    effect(() => {
      if (!isOpen.value) return;
      this.#fill();
      untracked(() => this.#place());
    });
  }

  /**
   * Shows the options that fit a text, with the first that begins with it marked, or the value.
   *
   * @param {string | Mixed | null} value
   * @param {string} [text]
   */
  open(value, text = "") {
    this.#search = text;
    this.#isOpen.value = true;
    this.#fill();
    const typed = text.trim();
    this.#active = typed
      ? likely(this.#shown, typed)
      : this.#shown.findIndex((one) => one.value === value);
    this.#place();
    this.#mark();
  }

  /** @param {number} by */
  move(by) {
    if (!this.#shown.length) return;
    const last = this.#shown.length - 1;
    const next = this.#active + by;
    if (Math.abs(by) === 1) this.#active = next < 0 ? last : next > last ? 0 : next;
    else this.#active = Math.max(0, Math.min(last, next));
    this.#mark();
  }

  /** The option that the arrow keys have come to, null for none. */
  active() {
    return this.#shown[this.#active] ?? null;
  }

  /** The first that fits, null for none. */
  first() {
    return this.#shown[0] ?? null;
  }

  #appear() {
    const place = () => this.#place();
    this.element.showPopover();
    addEventListener("scroll", place, true);
    addEventListener("resize", place);
    owned(() => {
      if (this.element.isConnected) this.element.hidePopover();
      set(this.#input, { "aria-activedescendant": null });
      removeEventListener("scroll", place, true);
      removeEventListener("resize", place);
    });
  }

  #fill() {
    const chosen = this.active()?.value;
    const words = wordsOf(this.#search);
    const matches = this.#options.value.filter((one) => fits(one, words));
    const shown = matches.slice(0, MAX_SHOWN);
    const typed = this.#search.trim();
    // Enter takes what is marked: the text itself is still to be had.
    const marked = typed ? shown[likely(shown, typed)] : undefined;
    if (this.#isFree && marked && textOf(marked) !== typed)
      shown.push({ value: typed, label: `“${typed}”`, note: "as typed" });
    this.#shown = shown;
    this.#active = shown.findIndex(({ value }) => value === chosen);
    const rest = matches.length - MAX_SHOWN;
    const note = rest > 0 ? `${rest} more. Type to search.` : shown.length ? "" : "No match.";
    this.element.replaceChildren(
      ...shown.map((choice, index) => this.#item(choice, index)),
      ...(note ? [el("div", { class: "wv-list-more" }, note)] : []),
    );
    this.#mark();
  }

  /**
   * @param {Choice} choice
   * @param {number} index
   */
  #item({ value, label: text, note, level }, index) {
    const name = el("span", { class: "wv-list-name" }, (text ?? value) || "(none)");
    return el(
      "div",
      {
        id: `${this.#id}-${index}`,
        class: "wv-option",
        role: "option",
        "aria-selected": "false",
        onclick: () => this.#choose(value),
      },
      name,
      note ? el("span", { class: "wv-list-note", "data-level": level }, note) : null,
    );
  }

  #mark() {
    const { children } = this.element;
    const active = this.#active;
    this.#shown.forEach((_, index) => {
      set(children[index], { "aria-selected": String(index === active) });
    });
    set(this.#input, { "aria-activedescendant": active < 0 ? null : `${this.#id}-${active}` });
    if (active >= 0) children[active].scrollIntoView({ block: "nearest" });
  }

  #place() {
    if (!this.#input.isConnected) return void (this.#isOpen.value = false);
    const { style } = this.element;
    const field = this.#input.getBoundingClientRect();
    const below = innerHeight - field.bottom - 8;
    const isAbove = below < 160 && field.top > below;
    style.minWidth = `${field.width}px`;
    style.maxHeight = `${Math.min(320, isAbove ? field.top - 8 : below)}px`;
    style.left = `${Math.max(4, Math.min(field.left, innerWidth - this.element.offsetWidth - 4))}px`;
    style.top = isAbove ? "auto" : `${field.bottom + 2}px`;
    style.bottom = isAbove ? `${innerHeight - field.top + 2}px` : "auto";
  }
}

/**
 * The place of the option of that text, or of the first that begins with it; -1 for none.
 *
 * @param {Choice[]} choices
 * @param {string} text
 */
function likely(choices, text) {
  const exact = choices.findIndex((one) => textOf(one) === text);
  if (exact >= 0) return exact;
  return choices.findIndex((one) => textOf(one).toLowerCase().startsWith(text.toLowerCase()));
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
