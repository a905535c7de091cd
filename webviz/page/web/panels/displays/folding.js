// Folding in this browser: groups are open at first, displays are not.
//
// Ids serve while the viewer runs; names last longer, so they are what is remembered.

import * as channel from "webviz/channel.js";
import { recall, remember } from "webviz/remember.js";

/** @import {Item} from "webviz/panels/displays/types.js" */

const KEY = "displays.folds";
const MAX_REMEMBERED = 500;

/** @type {Set<string>} */
const stored = new Set(recall(KEY, []));
/** @type {Set<string>} */
const toggled = new Set();
/** @type {Map<string, string>} */
const paths = new Map();

// After a lost connection, ids may be those of another viewer.
channel.onOpen(() => {
  toggled.clear();
  paths.clear();
});

/**
 * True if the content of a group, or the properties of a display, are shown below it.
 *
 * @param {Item} item
 */
export const isOpen = (item) => item.isGroup !== toggled.has(item.id);

/**
 * Folds or unfolds.
 *
 * @param {Item} item
 * @param {boolean} open
 */
export function setOpen(item, open) {
  if (isOpen(item) === open) return;
  const isToggled = item.isGroup !== open;
  toggled[isToggled ? "add" : "delete"](item.id);
  stored[isToggled ? "add" : "delete"](item.path);
  save();
}

/**
 * Knows new displays by their names, and follows those that are renamed or moved.
 *
 * @param {Item[]} items
 */
export function follow(items) {
  for (const { id, path } of items) {
    const before = paths.get(id);
    if (before === path) continue;
    paths.set(id, path);
    if (before === undefined) {
      if (stored.has(path)) toggled.add(id);
    } else if (toggled.has(id)) {
      stored.delete(before);
      stored.add(path);
      save();
    }
  }
}

function save() {
  remember(KEY, [...stored].slice(-MAX_REMEMBERED));
}
