// Switches by name, such as those of frames or of namespaces: check boxes with a search, for
// hundreds of names.

import { el, set, setChildren, setText } from "../dom.js";
import { icon, textButton } from "../icons.js";
import { sanitized } from "../sanitize.js";
import { watch } from "../stores.js";
import { wordsOf } from "../words.js";
import { searchField } from "./fields.js";
import { rowList, touchable } from "./rows.js";
import { sync } from "./sync.js";

/** @import {Control, ControlOptions} from "../types.js" */
/** @import {DeclaredProperty} from "../contents.js" */

const MAX_ROWS = 8;
const ROW_PX = 24;

/**
 * A dictionary of switches by the names of frames, or, if they are `offered`, by those that
 * `live(known)` sets, with how many things have each; see `control.js`. `follow(value)` sets what holds
 * for names that have no switch of their own.
 *
 * @param {Pick<DeclaredProperty, "offered">} property
 * @param {ControlOptions} options
 * @returns {Control}
 */
export function switches({ offered }, { label, change, refused }) {
  const height = touchable(ROW_PX);
  const noun = label.toLowerCase();
  /** @type {string[]} */
  let names = [];
  /** @type {Record<string, number | string>} */
  let counts = {};
  /** @type {Record<string, boolean>} */
  let current = {};
  let otherwise = true;
  /** @type {string[]} */
  let shown = [];

  const search = searchField(`Filter ${noun}`, show, { autocomplete: "off", spellcheck: "false" });
  /**
   * @param {string} text
   * @param {boolean} value
   * @param {string} tip
   */
  const button = (text, value, tip) => textButton(text, () => put(shown, value), { tip });
  const buttons = [
    button("All", true, `Switch on all ${noun} in the list`),
    button("None", false, `Switch off all ${noun} in the list`),
  ];
  const empty = el("div", { class: "wv-quiet wv-switches-empty", hidden: true });
  const list = rowList({
    label,
    height,
    make,
    update,
    choose: ({ key }) => put([key], !isOn(key)),
  });
  set(list.element, { "aria-multiselectable": "true" });
  const state = sync({
    /** @param {Record<string, boolean>} value */
    show(value) {
      current = value;
      show();
    },
    send: change,
    refused,
  });

  /** @param {string} name */
  const isOn = (name) => (Object.hasOwn(current, name) ? current[name] : otherwise);

  /**
   * Switches names; one that holds anyway needs no switch, so names that go leave nothing behind.
   *
   * @param {string[]} names
   * @param {boolean} value
   */
  function put(names, value) {
    const own = new Map(Object.entries(current));
    for (const name of names) {
      if (value === otherwise) own.delete(name);
      else own.set(name, value);
    }
    current = Object.fromEntries(own);
    show();
    state.edit(current);
  }

  function make() {
    const box = el("span", { class: "wv-box", "aria-hidden": "true" });
    const name = el("span", { class: "wv-ellipsis" });
    const count = el("span", { class: "wv-quiet wv-switch-count" });
    const row = el("div", { class: "wv-switch" }, box, name, count);
    return Object.assign(row, { wvParts: { box, name, count, mark: icon("check", 12) } });
  }

  /**
   * @param {ReturnType<typeof make>} row
   * @param {{key: string}} item
   */
  function update(row, { key }) {
    const { box, name, count, mark } = row.wvParts;
    setText(name, key === "" ? "(no name)" : sanitized(key));
    setText(count, Object.hasOwn(counts, key) ? String(counts[key]) : "");
    set(row, {
      "aria-checked": String(isOn(key)),
      title: key.length > 30 ? sanitized(key, 1000) : null,
    });
    setChildren(box, isOn(key) ? [mark] : []);
  }

  function show() {
    const all = [...new Set([...names, ...Object.keys(current)])].sort();
    const words = wordsOf(search.value);
    shown = all.filter((name) => words.every((word) => name.toLowerCase().includes(word)));
    list.element.style.height = `${Math.min(shown.length, MAX_ROWS) * height}px`;
    list.show(shown.map((key) => ({ key })));
    set(search, { placeholder: `Filter ${all.length} ${noun}`, disabled: !all.length });
    for (const each of buttons) set(each, { disabled: !shown.length });
    setText(empty, all.length ? `No match in ${noun}.` : `No ${noun} yet.`);
    set(empty, { hidden: shown.length > 0 });
  }

  const end = offered
    ? () => {}
    : watch("frames", (values) => {
        names = values.get("frames") ?? [];
        show();
      });
  show();
  return {
    element: el(
      "div",
      { class: "wv-switches" },
      el("div", { class: "wv-switches-head" }, search, buttons),
      list.element,
      empty,
    ),
    focus: () => search.focus(),
    describe: (text) => set(list.element, { "aria-description": text }),
    update: state.show,
    /** @param {Record<string, number | string>} known */
    live(known) {
      counts = known;
      names = Object.keys(known);
      show();
    },
    /** @param {boolean} value */
    follow(value) {
      otherwise = value;
      show();
    },
    end() {
      end();
      list.close();
    },
  };
}
