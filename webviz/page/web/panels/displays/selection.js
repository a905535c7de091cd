// Displays that are selected in this browser, and the one that keys act on.

import * as channel from "webviz/channel.js";
import { recall, remember } from "webviz/remember.js";

/** @import {Item} from "webviz/panels/displays/types.js" */

const KEY = "displays.selected";
const MAX_REMEMBERED = 100;

/** @type {Set<string>} */
const selected = new Set();
/** @type {string | null} */
let current = null;
/** @type {string | null} */
let anchor = null; // where Shift extends from
/** @type {Set<string>} */
let restored = new Set(recall(KEY, [])); // paths that are yet to be selected
/** @type {string | null} */
let added = null; // the id of a display that this page has made
let saved = JSON.stringify([...restored]);
/** @type {string | null} */
let successor = null; // what follows displays that this page removes
/** @type {Set<string>} */
let gone = new Set(); // what was selected when it went, until something else is selected

let isSeveral = false; // each click adds or removes, as with Ctrl: fingers have no keys
/** @type {() => void} */
let tell = () => {};
let place = 0; // of the current row, should it go

/**
 * Selects a display as soon as there is a row of it, and shows it.
 *
 * @param {string} id
 */
export function reveal(id) {
  added = id;
  tell();
}

// The row of what was added is there before the answer, or comes after it.
channel.on("Done", ({ result }) => result.display && reveal(result.display));
channel.onOpen(() => {
  restored = new Set(recall(KEY, []));
  selected.clear();
  gone = new Set();
});

export const ids = () => selected;
/** @param {string} id */
export const isSelected = (id) => selected.has(id);

/** The id of the row that keys are about; null before the first. */
export const active = () => current;

/**
 * Calls `listener` when this page has added a display; the newest one is called.
 *
 * @param {() => void} listener
 */
export const onAdded = (listener) => (tell = listener);

/**
 * Makes a row the one that keys are about.
 *
 * @param {string | null} id
 */
export const activate = (id) => (current = id);

/**
 * Selects one row and no other; null for none.
 *
 * @param {string | null} id
 */
export function choose(id) {
  gone = new Set();
  selected.clear();
  if (id !== null) selected.add(id);
  current = anchor = id;
}

/**
 * Adds a row to the selection, or takes it away.
 *
 * @param {string} id
 */
export function toggle(id) {
  gone = new Set();
  if (!selected.delete(id)) selected.add(id);
  current = anchor = id;
}

export const severalAtOnce = () => isSeveral;
/**
 * True if each click adds a row, or takes it away.
 *
 * @param {boolean} wanted
 */
export const selectSeveral = (wanted) => (isSeveral = wanted);

/**
 * Selects from where the selection began to a row.
 *
 * @param {string} id
 * @param {Item[]} rows
 */
export function extend(id, rows) {
  gone = new Set();
  const order = rows.map((row) => row.id);
  const from = Math.max(order.indexOf(anchor ?? ""), 0);
  const to = order.indexOf(id);
  selected.clear();
  for (const each of order.slice(Math.min(from, to), Math.max(from, to) + 1)) selected.add(each);
  current = id;
}

/**
 * Selects `id` when those that are selected now are gone, since this page removes them.
 *
 * @param {string | null} id
 */
export const leaveTo = (id) => (successor = id);

/**
 * Deselects what is gone, and selects what this page has added; returns the id of that, or null.
 *
 * @param {Item[]} items
 */
export function follow(items) {
  const there = new Map(items.map((item) => [item.id, item]));
  if (restored.size && items.length > 1) {
    for (const { id, path } of items) if (restored.has(path)) selected.add(id);
    current = anchor = selected.values().next().value ?? null;
    restored.clear();
  }
  comeBack(there);
  const went = [...selected].filter((id) => !there.has(id));
  for (const id of went) selected.delete(id);
  const remembered = gone; // `choose` forgets it, which is not meant here
  if (added !== null && there.has(added)) {
    const id = added;
    added = null;
    choose(id);
    return id;
  }
  if (current === null || !there.has(current)) {
    const next = successor !== null && there.has(successor) ? successor : null;
    if (next && !selected.size) choose(next);
    else current = next ?? items[Math.min(place, items.length - 1)]?.id ?? null;
    successor = null;
  }
  for (const id of went) remembered.add(id);
  gone = items.length > 1 ? remembered : new Set(); // of another config
  place = Math.max(
    items.findIndex(({ id }) => id === current),
    0,
  );
  return null;
}

/**
 * Undo brings back what was removed: keys are about that again, and not about its neighbour.
 *
 * @param {Map<string, Item>} there
 */
function comeBack(there) {
  const back = [...gone].filter((id) => there.has(id));
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
  if (restored.size) return;
  const paths = items.filter(({ id }) => selected.has(id)).map(({ path }) => path);
  const text = JSON.stringify(paths.slice(0, MAX_REMEMBERED));
  if (text === saved) return;
  saved = text;
  remember(KEY, JSON.parse(text));
}
