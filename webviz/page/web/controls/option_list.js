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

/**
 * A list of rows that a field searches; `choose(row)` is called by Enter and by a click.
 *
 * Rows are `{id, title}`, and if there are: `icon`, `picture`, an address, `line` below the title, `note` at its right,
 * `key`, `group`, `{title, line, note}` above the first of several, `isWithin` for rows that are set in
 * below it, `label` for what reads the page aloud, `checked` for rows of which several are taken, and
 * `disabled`. Returns `{element, show(rows), active()}`, the last of which is an id.
 *
 * @param {HTMLInputElement} input
 * @param {string} label
 * @param {(row: OptionRow, event: MouseEvent | KeyboardEvent) => void} choose
 */
export function optionList(input, label, choose) {
  const prefix = newId("options");
  const element = el("div", {
    class: "wv-picks",
    role: "listbox",
    id: prefix,
    "aria-label": label,
  });
  /** @type {OptionRow[]} */
  let rows = [];
  /** @type {Map<OptionRow["id"], {text: string, element: HTMLElement}>} */
  let made = new Map();
  /** @type {OptionRow["id"] | null} */
  let active = null;

  set(input, {
    role: "combobox",
    "aria-controls": prefix,
    "aria-expanded": "true",
    "aria-autocomplete": "list",
    autocomplete: "off",
    spellcheck: "false",
  });
  input.addEventListener("keydown", (event) => {
    const usable = rows.filter((row) => !row.disabled);
    const at = usable.findIndex(({ id }) => id === active);
    const step = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 }[event.key];
    if (event.key === "Enter" && !event.isComposing) {
      if (at >= 0) choose(usable[at], event);
    } else if (step && usable.length) {
      const next =
        Math.abs(step) > 1
          ? Math.max(0, Math.min(at + step, usable.length - 1))
          : (at + step + usable.length) % usable.length;
      mark(usable[next].id)?.scrollIntoView({ block: "nearest" });
    } else {
      return;
    }
    event.preventDefault();
  });

  /** @param {OptionRow["id"] | null} id */
  function mark(id) {
    const before = elementOf(active);
    if (before) set(before, { "aria-selected": "false" });
    active = id;
    const chosen = elementOf(active);
    if (chosen) set(chosen, { "aria-selected": "true" });
    set(input, { "aria-activedescendant": chosen?.id });
    return chosen;
  }

  /** @param {OptionRow["id"] | null} id */
  const elementOf = (id) => (id === null ? undefined : made.get(id)?.element);

  /** @param {OptionRow} row */
  function rowOf(row) {
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
        onpointermove: () => disabled || active === row.id || mark(row.id),
        // The field keeps the focus.
        onpointerdown: (event) => event.preventDefault(),
        onclick: (event) => disabled || choose(row, event),
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

  /** @param {OptionRow[]} next */
  function show(next) {
    const before = made;
    made = new Map();
    rows = next;
    /** @type {HTMLElement[]} */
    const children = [];
    /** @type {OptionRow["group"]} */
    let group;
    for (const row of rows) {
      const text = JSON.stringify(row);
      const known = before.get(row.id);
      const one = known?.text === text ? known : { text, element: rowOf(row) };
      made.set(row.id, one);
      if (row.group?.title !== group?.title && row.group) children.push(headOf(row.group));
      group = row.group;
      children.push(one.element);
    }
    setChildren(element, children);
    const usable = rows.filter((row) => !row.disabled);
    mark(usable.some(({ id }) => id === active) ? active : (usable[0]?.id ?? null));
  }

  // With other words, the best match is chosen.
  input.addEventListener("input", () => (active = null));
  return { element, show, active: () => active };
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
  const found = scored.filter(({ points }) => points > 0);
  return found.sort((a, b) => b.points - a.points).map(({ item }) => item);
}
