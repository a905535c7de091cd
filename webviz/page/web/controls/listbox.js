// The list below a combobox, over everything else.

import { el, newId, set } from "webviz/dom.js";
import { each, effect, owned, signal, untracked } from "webviz/signals.js";
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
  #choices = signal(/** @type {Choice[]} */ ([]));
  #note = signal("");
  #active = signal(-1);
  #search = "";

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
    this.element = el(
      "div",
      {
        id: this.#id,
        class: "wv-list",
        role: "listbox",
        "aria-label": label,
        popover: "manual",
        onpointerdown: (event) => event.preventDefault(), // the field keeps the focus
      },
      each(
        () => this.#choices.value.map((choice, index) => ({ ...choice, index })),
        ({ index }) => index,
        (choice) => this.#item(choice),
      ),
      () => this.#note.value && el("div", { class: "wv-list-more" }, this.#note.value),
    );
    const marked = () => (isOpen.value && this.#active.value >= 0 ? this.#active.value : null);
    set(input, {
      "aria-controls": this.#id,
      "aria-expanded": () => String(isOpen.value),
      "aria-activedescendant": () => (marked() === null ? null : `${this.#id}-${marked()}`),
    });
    effect(() => {
      if (isOpen.value) this.#appear();
    });
    effect(() => {
      if (isOpen.value) this.#fill();
    });
    // Last, since they need what the others have changed.
    effect(() => {
      if (isOpen.value && this.#choices.value) untracked(() => this.#place());
    });
    effect(() => {
      if (isOpen.value && this.#choices.value) this.#scroll(this.#active.value);
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
    const choices = this.#choices.value;
    this.#active.value = typed
      ? likely(choices, typed)
      : choices.findIndex((one) => one.value === value);
  }

  /** @param {number} by */
  move(by) {
    const last = this.#choices.value.length - 1;
    if (last < 0) return;
    const next = this.#active.value + by;
    if (Math.abs(by) === 1) this.#active.value = next < 0 ? last : next > last ? 0 : next;
    else this.#active.value = Math.max(0, Math.min(last, next));
  }

  /** The option that the arrow keys have come to, null for none. */
  active() {
    return this.#choices.value[this.#active.value] ?? null;
  }

  /** The first that fits, null for none. */
  first() {
    return this.#choices.value[0] ?? null;
  }

  #appear() {
    const place = () => this.#place();
    this.element.showPopover();
    addEventListener("scroll", place, true);
    addEventListener("resize", place);
    owned(() => {
      if (this.element.isConnected) this.element.hidePopover();
      removeEventListener("scroll", place, true);
      removeEventListener("resize", place);
    });
  }

  #fill() {
    const chosen = untracked(() => this.active()?.value);
    const words = wordsOf(this.#search);
    const matches = this.#options.value.filter((one) => fits(one, words));
    const choices = matches.slice(0, MAX_SHOWN);
    const typed = this.#search.trim();
    // Enter takes what is marked: the text itself is still to be had.
    const marked = typed ? choices[likely(choices, typed)] : undefined;
    if (this.#isFree && marked && textOf(marked) !== typed)
      choices.push({ value: typed, label: `“${typed}”`, note: "as typed" });
    this.#choices.value = choices;
    this.#active.value = choices.findIndex(({ value }) => value === chosen);
    const rest = matches.length - MAX_SHOWN;
    this.#note.value =
      rest > 0 ? `${rest} more. Type to search.` : choices.length ? "" : "No match.";
  }

  /** @param {Signal<Choice & {index: number}>} choice */
  #item(choice) {
    const { index } = untracked(() => choice.value);
    const note = () => choice.value.note;
    return el(
      "div",
      {
        id: `${this.#id}-${index}`,
        class: "wv-option",
        role: "option",
        "aria-selected": () => String(index === this.#active.value),
        onclick: () => this.#choose(choice.value.value),
      },
      el("span", { class: "wv-list-name" }, () => textOf(choice.value) || "(none)"),
      () =>
        note() && el("span", { class: "wv-list-note", "data-level": choice.value.level }, note()),
    );
  }

  /** @param {number} active */
  #scroll(active) {
    if (active >= 0) this.element.children[active]?.scrollIntoView({ block: "nearest" });
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
