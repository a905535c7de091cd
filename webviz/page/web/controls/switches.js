// Switches by name, such as those of frames or of namespaces: check boxes with a search, for
// hundreds of names.

import { el, set } from "webviz/dom.js";
import { icon, textButton } from "webviz/icons.js";
import { sanitized } from "webviz/sanitize.js";
import { computed, effect, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { wordsOf } from "webviz/words.js";
import { searchField } from "webviz/controls/fields.js";
import { rowList, touchable } from "webviz/controls/rows.js";
import { sync } from "webviz/controls/sync.js";

/** @import {Control, ControlOptions} from "webviz/types.js" */
/** @import {DeclaredProperty} from "webviz/contents.js" */

/** @typedef {Record<string, boolean>} Switches */

const MAX_ROWS = 8;
const ROW_PX = 24;

const frames = store("frames");

/**
 * A dictionary of switches by the names of frames, or, if they are `offered`, by those that are
 * `known`, with how many things have each; see `control.js`. What is `otherwise` holds for names that
 * have no switch of their own.
 *
 * @param {Pick<DeclaredProperty, "offered">} property
 * @param {ControlOptions<Switches>} options
 * @returns {Control}
 */
export function switches({ offered }, options) {
  const { label, help } = options;
  const height = touchable(ROW_PX);
  const noun = label.toLowerCase();
  const words = signal(/** @type {string[]} */ ([]));
  const { all, counts, isOn, put } = valuesOf(offered, options);
  const matches = computed(() =>
    all.value.filter((name) => words.value.every((word) => name.toLowerCase().includes(word))),
  );
  /** @type {HTMLInputElement} */
  const search = searchField(`Filter ${noun}`, () => (words.value = wordsOf(search.value)), {
    autocomplete: "off",
    spellcheck: "false",
    placeholder: () => `Filter ${all.value.length} ${noun}`,
    disabled: () => !all.value.length,
  });
  /**
   * @param {string} text
   * @param {boolean} value
   * @param {string} tip
   */
  const button = (text, value, tip) =>
    textButton(text, () => put(matches.value, value), {
      tip,
      disabled: () => !matches.value.length,
    });
  const list = rowList({
    label,
    height,
    row: (/** @type {() => {key: string}} */ item) => {
      const { key } = item();
      return switchRow(key, () => isOn(key), counts);
    },
    choose: ({ key }) => put([key], !isOn(key)),
  });
  set(list.element, { "aria-multiselectable": "true", "aria-description": help });
  effect(() => {
    list.element.style.height = `${Math.min(matches.value.length, MAX_ROWS) * height}px`;
    list.show(matches.value.map((key) => ({ key })));
  });
  const nothing = () => (all.value.length ? `No match in ${noun}.` : `No ${noun} yet.`);
  const head = [
    search,
    button("All", true, `Switch on all ${noun} in the list`),
    button("None", false, `Switch off all ${noun} in the list`),
  ];
  const empty = { class: "wv-quiet wv-switches-empty", hidden: () => matches.value.length > 0 };
  return {
    element: el(
      "div",
      { class: "wv-switches" },
      el("div", { class: "wv-switches-head" }, head),
      list.element,
      el("div", empty, nothing),
    ),
    focus: () => search.focus(),
  };
}

/**
 * All names, how many things have each, which are on, and what switches them.
 *
 * @param {DeclaredProperty["offered"]} offered
 * @param {ControlOptions<Switches>} options
 */
function valuesOf(offered, options) {
  const current = signal(/** @type {Switches} */ ({}));
  const counts = () => /** @type {Record<string, number | string>} */ (options.live?.() ?? {});
  const otherwise = () => options.otherwise?.() !== false;
  const all = computed(() => {
    const names = offered ? Object.keys(counts()) : (frames.get("frames") ?? []);
    return [...new Set([...names, ...Object.keys(current.value)])].sort();
  });
  /** @type {ReturnType<typeof sync<Switches>>} */
  const state = sync({
    ...options,
    show: (value) => (current.value = /** @type {Switches} */ (value)),
  });
  return {
    all,
    counts,
    /** @param {string} name */
    isOn: (name) => (Object.hasOwn(current.value, name) ? current.value[name] : otherwise()),
    /**
     * Switches names; one that holds anyway needs no switch, so names that go leave nothing behind.
     *
     * @param {string[]} names
     * @param {boolean} value
     */
    put(names, value) {
      const own = new Map(Object.entries(current.value));
      for (const name of names) {
        if (value === otherwise()) own.delete(name);
        else own.set(name, value);
      }
      state.edit((current.value = Object.fromEntries(own)));
    },
  };
}

/**
 * @param {string} key
 * @param {() => boolean} isOn
 * @param {() => Record<string, number | string>} counts
 */
const switchRow = (key, isOn, counts) =>
  el(
    "div",
    {
      class: "wv-switch",
      "aria-checked": () => String(isOn()),
      title: key.length > 30 ? sanitized(key, 1000) : null,
    },
    el("span", { class: "wv-box", "aria-hidden": "true" }, () =>
      isOn() ? icon("check", 12) : null,
    ),
    el("span", { class: "wv-ellipsis" }, key === "" ? "(no name)" : sanitized(key)),
    el("span", { class: "wv-quiet wv-switch-count" }, () =>
      Object.hasOwn(counts(), key) ? String(counts()[key]) : "",
    ),
  );
