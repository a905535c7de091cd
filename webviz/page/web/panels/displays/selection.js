// Displays that are selected in this browser, and the one that keys act on.

import * as channel from "webviz/channel.js";
import { recall, remember } from "webviz/remember.js";
import { signal, untracked } from "webviz/signals.js";

/** @import {Item} from "webviz/panels/displays/types.js" */

const KEY = "displays.selected";
const MAX_REMEMBERED = 100;

/** @type {Set<string>} */
const selected = new Set();
const current = signal(/** @type {string | null} */ (null));
const anchor = signal(/** @type {string | null} */ (null)); // where Shift extends from
/** Paths that are yet to be selected. */
const restored = signal(recalled());
const saved = signal(JSON.stringify([...restored.value]));
/** The id of a display that this page has made, until there is a row of it. */
const awaited = signal(/** @type {string | null} */ (null));
/** The display that follows those that this page removes. */
const successor = signal(/** @type {string | null} */ (null));
/** Displays that were selected when they went, until others are selected. */
const formerIds = signal(/** @type {Set<string>} */ (new Set()));
/** True if each click adds or removes, as with Ctrl: fingers have no keys. */
const isSeveral = signal(false);
const place = signal(0); // of the current row, should it go

/** @returns {Set<string>} */
function recalled() {
  return new Set(recall(KEY, []));
}

/**
 * Selects a display as soon as there is a row of it, and shows it.
 *
 * @param {string} id
 */
export const reveal = (id) => void (awaited.value = id);

/** The id of that display, null for none; read in effects. */
export const added = () => awaited.value;

// The row of what was added is there before the answer, or comes after it.
channel.on("CommandResult", ({ result }) => result.display && reveal(result.display));
channel.onOpen(() => {
  restored.value = recalled();
  selected.clear();
  formerIds.value = new Set();
});

export const ids = () => selected;
/** @param {string} id */
export const isSelected = (id) => selected.has(id);

/** The id of the row that keys are about; null before the first. */
export const active = () => untracked(() => current.value); // rows follow the list

/**
 * Makes a row the one that keys are about.
 *
 * @param {string | null} id
 */
export const activate = (id) => void (current.value = id);

/**
 * Selects one row and no other; null for none.
 *
 * @param {string | null} id
 */
export function choose(id) {
  formerIds.value = new Set();
  selected.clear();
  if (id !== null) selected.add(id);
  current.value = anchor.value = id;
}

/**
 * Adds a row to the selection, or takes it away.
 *
 * @param {string} id
 */
export function toggle(id) {
  formerIds.value = new Set();
  if (!selected.delete(id)) selected.add(id);
  current.value = anchor.value = id;
}

export const severalAtOnce = () => isSeveral.value;
/**
 * True if each click adds a row, or takes it away.
 *
 * @param {boolean} isOn
 */
export const selectSeveral = (isOn) => void (isSeveral.value = isOn);

/**
 * Selects from where the selection began to a row.
 *
 * @param {string} id
 * @param {Item[]} rows
 */
export function extend(id, rows) {
  formerIds.value = new Set();
  const order = rows.map((row) => row.id);
  const from = Math.max(order.indexOf(anchor.value ?? ""), 0);
  const to = order.indexOf(id);
  selected.clear();
  for (const each of order.slice(Math.min(from, to), Math.max(from, to) + 1)) selected.add(each);
  current.value = id;
}

/**
 * Selects `id` when those that are selected now are gone, since this page removes them.
 *
 * @param {string | null} id
 */
export const leaveTo = (id) => void (successor.value = id);

/**
 * Deselects what is gone, and selects what this page has added; returns the id of that, or null.
 *
 * @param {Item[]} items
 */
export function follow(items) {
  const there = new Map(items.map((item) => [item.id, item]));
  restore(items);
  comeBack(there);
  const went = [...selected].filter((id) => !there.has(id));
  for (const id of went) selected.delete(id);
  const remembered = formerIds.value; // `choose` forgets it, which is not meant here
  const id = awaited.value;
  if (id !== null && there.has(id)) {
    awaited.value = null;
    choose(id);
    return id;
  }
  if (current.value === null || !there.has(current.value)) {
    const { value: after } = successor;
    const next = after !== null && there.has(after) ? after : null;
    if (next && !selected.size) choose(next);
    else current.value = next ?? items[Math.min(place.value, items.length - 1)]?.id ?? null;
    successor.value = null;
  }
  const isOther = items.length <= 1; // another config
  formerIds.value = new Set(isOther ? [] : [...remembered, ...went]);
  const at = items.findIndex(({ id }) => id === current.value);
  place.value = Math.max(at, 0);
  return null;
}

/**
 * Selects what was selected when this page was open before, once it is there.
 *
 * @param {Item[]} items
 */
function restore(items) {
  const { value: paths } = restored;
  if (!paths.size || items.length <= 1) return;
  for (const { id, path } of items) if (paths.has(path)) selected.add(id);
  current.value = anchor.value = selected.values().next().value ?? null;
  restored.value = new Set();
}

/**
 * Undo brings back what was removed: keys are about that again, and not about its neighbour.
 *
 * @param {Map<string, Item>} there
 */
function comeBack(there) {
  const back = [...formerIds.value].filter((id) => there.has(id));
  if (!back.length) return;
  choose(back[0]);
  for (const id of back) selected.add(id);
}

/**
 * Keeps it for the next time this page is opened.
 *
 * @param {Item[]} items
 */
export function save(items) {
  if (restored.value.size) return;
  const paths = items.filter(({ id }) => selected.has(id)).map(({ path }) => path);
  const text = JSON.stringify(paths.slice(0, MAX_REMEMBERED));
  if (text === saved.value) return;
  saved.value = text;
  remember(KEY, JSON.parse(text));
}
