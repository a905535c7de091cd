// Which displays this browser has selected, and which one keys are about.

import * as channel from "../../channel.js";
import { recall, remember } from "../../remember.js";

const KEY = "displays.selected";
const MAX_REMEMBERED = 100;

const selected = new Set();
let current = null;
let anchor = null; // where Shift extends from
let restored = new Set(recall(KEY, [])); // paths that are yet to be selected
let added = null; // the id of a display that this page has made
let saved = JSON.stringify([...restored]);
let successor = null; // what follows displays that this page removes

let tell = () => {};
let place = 0; // of the current row, should it go

/** Selects a display as soon as there is a row of it, and shows it. */
export function reveal(id) {
  added = id;
  tell();
}

// The row of what was added is there before the answer, or comes after it.
channel.on("Done", ({ display }) => display && reveal(display));
channel.onOpen(() => {
  restored = new Set(recall(KEY, []));
  selected.clear();
});

export const ids = () => selected;
export const isSelected = (id) => selected.has(id);

/** The id of the row that keys are about; null before the first. */
export const active = () => current;

/** Calls `listener` when this page has added a display; the newest one is called. */
export const onAdded = (listener) => (tell = listener);

/** Makes a row the one that keys are about. */
export const activate = (id) => (current = id);

/** Selects one row and no other; null for none. */
export function choose(id) {
  selected.clear();
  if (id !== null) selected.add(id);
  current = anchor = id;
}

/** Adds a row to the selection, or takes it away. */
export function toggle(id) {
  if (!selected.delete(id)) selected.add(id);
  current = anchor = id;
}

/** Selects from where the selection began to a row. */
export function extend(id, rows) {
  const order = rows.map((row) => row.id);
  const from = Math.max(order.indexOf(anchor), 0);
  const to = order.indexOf(id);
  selected.clear();
  for (const each of order.slice(Math.min(from, to), Math.max(from, to) + 1)) selected.add(each);
  current = id;
}

/** Selects `id` when those that are selected now are gone, since this page removes them. */
export const leaveTo = (id) => (successor = id);

/** Deselects what is gone, and selects what this page has added; returns the id of that, or null. */
export function follow(items) {
  const there = new Map(items.map((item) => [item.id, item]));
  if (restored.size && items.length > 1) {
    for (const { id, path } of items) if (restored.has(path)) selected.add(id);
    current = anchor = selected.values().next().value ?? null;
    restored.clear();
  }
  for (const id of selected) if (!there.has(id)) selected.delete(id);
  if (there.has(added)) {
    const id = added;
    added = null;
    choose(id);
    return id;
  }
  if (!there.has(current)) {
    const next = there.has(successor) ? successor : null;
    if (next && !selected.size) choose(next);
    else current = next ?? items[Math.min(place, items.length - 1)]?.id ?? null;
    successor = null;
  }
  place = Math.max(items.findIndex(({ id }) => id === current), 0);
  return null;
}

/** Keeps it for the next time this page is opened. */
export function save(items) {
  if (restored.size) return;
  const paths = items.filter(({ id }) => selected.has(id)).map(({ path }) => path);
  const text = JSON.stringify(paths.slice(0, MAX_REMEMBERED));
  if (text === saved) return;
  saved = text;
  remember(KEY, JSON.parse(text));
}
