// A list below a search field: the field keeps the focus, arrow keys walk through the list.

import { el, newId, set, setChildren } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { wordsOf } from "webviz/words.js";
import { keyText } from "webviz/keys.js";

/**
 * @typedef {{
 *   id: string | number, title: string, icon?: string, picture?: string, line?: string, note?: string,
 *   key?: string, group?: {title?: string, line?: string, note?: string}, isWithin?: boolean,
 *   label?: string, checked?: boolean, disabled?: boolean, refusal?: string,
 * }} OptionRow
 */

/** @typedef {(row: OptionRow, event: MouseEvent | KeyboardEvent) => void} Choose */

/** @type {Record<string, number | undefined>} */
const STEPS = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 };

/**
 * A list of rows that a field searches; `choose(row)` is called by Enter and by a click.
 *
 * Rows are `{id, title}`, and if there are: `icon`, `picture`, an address, `line` below the title, `note` at its right,
 * `key`, `group`, `{title, line, note}` above the first of several, `isWithin` for rows that are set in
 * below it, `label` for what reads the page aloud, `checked` for rows of which several are taken, and
 * `disabled`.
 */
export class OptionList {
  #input;
  #choose;
  /** @type {OptionRow[]} */
  #rows = [];
  /** @type {Map<OptionRow["id"], {text: string, element: HTMLElement}>} */
  #elements = new Map();
  /** @type {OptionRow["id"] | null} */
  #active = null;

  /**
   * @param {HTMLInputElement} input
   * @param {string} label
   * @param {Choose} choose
   */
  constructor(input, label, choose) {
    const id = newId("options");
    this.#input = input;
    this.#choose = choose;
    this.element = el("div", { class: "wv-picks", role: "listbox", id, "aria-label": label });
    set(input, {
      role: "combobox",
      "aria-controls": id,
      "aria-expanded": "true",
      "aria-autocomplete": "list",
      autocomplete: "off",
      spellcheck: "false",
    });
    input.addEventListener("keydown", (event) => this.#press(event));
    // With other words, the best match is chosen.
    input.addEventListener("input", () => (this.#active = null));
  }

  /** The id of the row that Enter chooses, null for none. */
  active() {
    return this.#active;
  }

  /** @param {OptionRow[]} rows */
  show(rows) {
    const before = this.#elements;
    this.#elements = new Map();
    this.#rows = rows;
    /** @type {HTMLElement[]} */
    const children = [];
    /** @type {OptionRow["group"]} */
    let group;
    for (const row of rows) {
      const text = JSON.stringify(row);
      const previous = before.get(row.id);
      const one = previous?.text === text ? previous : { text, element: this.#elementFor(row) };
      this.#elements.set(row.id, one);
      if (row.group?.title !== group?.title && row.group) children.push(headOf(row.group));
      group = row.group;
      children.push(one.element);
    }
    setChildren(this.element, children);
    const usable = this.#usable();
    const isThere = usable.some(({ id }) => id === this.#active);
    this.#mark(isThere ? this.#active : (usable[0]?.id ?? null));
  }

  #usable() {
    return this.#rows.filter((row) => !row.disabled);
  }

  /** @param {OptionRow["id"] | null} id */
  #mark(id) {
    const before = this.#elementOf(this.#active);
    if (before) set(before, { "aria-selected": "false" });
    this.#active = id;
    const chosen = this.#elementOf(id);
    if (chosen) set(chosen, { "aria-selected": "true" });
    set(this.#input, { "aria-activedescendant": chosen?.id });
    return chosen;
  }

  /** @param {OptionRow["id"] | null} id */
  #elementOf(id) {
    return id === null ? undefined : this.#elements.get(id)?.element;
  }

  /** @param {OptionRow} row */
  #elementFor(row) {
    return elementFor(row, {
      point: () => row.disabled || this.#active === row.id || this.#mark(row.id),
      choose: (event) => row.disabled || this.#choose(row, event),
    });
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    const usable = this.#usable();
    const at = usable.findIndex(({ id }) => id === this.#active);
    const step = STEPS[event.key];
    if (event.key === "Enter" && !event.isComposing) {
      if (at >= 0) this.#choose(usable[at], event);
    } else if (step && usable.length) {
      const next =
        Math.abs(step) > 1
          ? Math.max(0, Math.min(at + step, usable.length - 1))
          : (at + step + usable.length) % usable.length;
      this.#mark(usable[next].id)?.scrollIntoView({ block: "nearest" });
    } else {
      return;
    }
    event.preventDefault();
  }
}

/**
 * @param {OptionRow} row
 * @param {{point: () => void, choose: (event: MouseEvent) => void}} listeners
 */
function elementFor(row, { point, choose }) {
  const { title, icon: name, picture, line, note, key, label, checked, disabled, refusal } = row;
  return el(
    "div",
    {
      class: row.isWithin ? "wv-pick wv-pick-within" : "wv-pick",
      "aria-label": label,
      role: "option",
      id: newId("option"),
      "aria-selected": "false",
      "aria-disabled": disabled ? "true" : null,
      "data-why": refusal || null,
      "aria-checked": checked === undefined ? null : String(checked),
      onpointermove: point,
      // The field keeps the focus.
      onpointerdown: (event) => event.preventDefault(),
      onclick: choose,
    },
    checked === undefined
      ? null
      : el("span", { class: "wv-box" }, checked ? icon("check", 12) : null),
    name ? el("span", { class: "wv-pick-icon" }, icon(name)) : null,
    picture === undefined ? null : pictureOf(picture),
    textOf("wv-pick-title", title, line),
    note ? el("span", { class: "wv-pick-note" }, note) : null,
    key ? el("kbd", {}, keyText(key)) : null,
  );
}

/**
 * @param {string} name
 * @param {string} [title]
 * @param {string} [line]
 */
const textOf = (name, title, line) =>
  el(
    "span",
    { class: "wv-pick-text" },
    el("span", { class: name }, title),
    line ? el("span", { class: "wv-pick-line" }, line) : null,
  );

/** @param {NonNullable<OptionRow["group"]>} group */
const headOf = ({ title, line, note }) =>
  el(
    "div",
    { class: "wv-pick-group", role: "presentation" },
    textOf("wv-pick-head", title, line),
    note ? el("span", { class: "wv-pick-note" }, note) : null,
  );

/**
 * Those without one keep its place.
 *
 * @param {string} picture
 */
function pictureOf(picture) {
  const attributes = { class: "wv-pick-picture", width: 64, height: 48 };
  return picture ? el("img", { ...attributes, src: picture, alt: "" }) : el("span", attributes);
}

/**
 * Those with every word of a text in what `textOf` says of them, the best match first.
 *
 * @template T
 * @param {T[]} all
 * @param {string} text
 * @param {(item: T) => string[]} textOf
 */
export function search(all, text, textOf) {
  const words = wordsOf(text);
  if (!words.length) return all;
  /** @param {T} item */
  const score = (item) => {
    const [title, more] = textOf(item).map((part) => part.toLowerCase());
    if (!words.every((word) => title.includes(word) || more.includes(word))) return 0;
    if (title.startsWith(words[0])) return 4;
    if (words.every((word) => title.includes(` ${word}`) || title.includes(`/${word}`))) return 3;
    return words.every((word) => title.includes(word)) ? 2 : 1;
  };
  const scored = all.map((item) => ({ item, points: score(item) }));
  const matches = scored.filter(({ points }) => points > 0);
  return matches.sort((a, b) => b.points - a.points).map(({ item }) => item);
}
