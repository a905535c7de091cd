// A list below a search field: the field keeps the focus, arrow keys walk through the list.

import { el, set, setChildren } from "../dom.js";
import { icon } from "../icons.js";
import { wordsOf } from "../words.js";
import { keyText } from "./keys.js";

let count = 0;

/**
 * A list of rows that a field searches; `choose(row)` is called by Enter and by a click.
 *
 * Rows are `{id, title}`, and if there are: `icon`, `picture`, an address, `line` below the title, `note` at its right,
 * `key`, `group`, `{title, line, note}` above the first of several, `isWithin` for rows that are set in
 * below it, `label` for what reads the page aloud, `checked` for rows of which several are taken, and
 * `disabled`. Returns `{element, show(rows), active()}`, the last of which is an id.
 */
export function optionList(input, label, choose) {
  count += 1;
  const prefix = `wv-options-${count}-`;
  const element = el("div", {
    class: "wv-picks",
    role: "listbox",
    id: prefix,
    "aria-label": label,
  });
  let rows = [];
  let made = new Map();
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
      mark(usable[next].id);
      made.get(active).element.scrollIntoView({ block: "nearest" });
    } else {
      return;
    }
    event.preventDefault();
  });

  function mark(id) {
    if (made.has(active)) set(made.get(active).element, { "aria-selected": "false" });
    active = id;
    const chosen = made.get(active)?.element;
    if (chosen) set(chosen, { "aria-selected": "true" });
    set(input, { "aria-activedescendant": chosen?.id });
  }

  function rowOf(row, number) {
    const { title, icon: name, picture, line, note, key, label, checked, disabled, refusal } = row;
    return el(
      "div",
      {
        class: row.isWithin ? "wv-pick wv-pick-within" : "wv-pick",
        "aria-label": label,
        role: "option",
        id: prefix + number,
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

  function show(next) {
    const before = made;
    made = new Map();
    rows = next;
    const children = [];
    let group = null;
    for (const row of rows) {
      const text = JSON.stringify(row);
      const known = before.get(row.id);
      count += known ? 0 : 1;
      const isSame = known?.text === text;
      made.set(row.id, isSame ? known : { text, element: rowOf(row, count) });
      if (row.group?.title !== group?.title && row.group) children.push(headOf(row.group));
      group = row.group;
      children.push(made.get(row.id).element);
    }
    setChildren(element, children);
    const usable = rows.filter((row) => !row.disabled);
    mark(usable.some(({ id }) => id === active) ? active : usable[0]?.id);
  }

  // With other words, the best match is chosen.
  input.addEventListener("input", () => (active = null));
  return { element, show, active: () => active };
}

const textOf = (name, title, line) =>
  el(
    "span",
    { class: "wv-pick-text" },
    el("span", { class: name }, title),
    line ? el("span", { class: "wv-pick-line" }, line) : null,
  );

const headOf = ({ title, line, note }) =>
  el(
    "div",
    { class: "wv-pick-group", role: "presentation" },
    textOf("wv-pick-head", title, line),
    note ? el("span", { class: "wv-pick-note" }, note) : null,
  );

// Those without one keep its place.
function pictureOf(picture) {
  const attributes = { class: "wv-pick-picture", width: 64, height: 48 };
  return picture ? el("img", { ...attributes, src: picture, alt: "" }) : el("span", attributes);
}

/** Those with every word of a text in what `textOf` says of them, the best match first. */
export function search(all, text, textOf) {
  const words = wordsOf(text);
  if (!words.length) return all;
  const score = (item) => {
    const [title, more] = textOf(item).map((part) => part.toLowerCase());
    if (!words.every((word) => title.includes(word) || more.includes(word))) return 0;
    if (title.startsWith(words[0])) return 4;
    if (words.every((word) => title.includes(` ${word}`) || title.includes(`/${word}`))) return 3;
    return words.every((word) => title.includes(word)) ? 2 : 1;
  };
  const scored = all.map((item) => [score(item), item]).filter(([points]) => points > 0);
  return scored.sort(([a], [b]) => b - a).map(([, item]) => item);
}
