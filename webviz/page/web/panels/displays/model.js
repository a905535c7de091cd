// The displays and groups as a tree, and which of them are rows of the list.

import { wordsOf } from "webviz/words.js";

/** @import {Item, Model} from "webviz/panels/displays/types.js" */
/** @import {ValuesOf} from "webviz/types.js" */

const NAME_IN_PATH = 80;

export const GLOBAL = "global";

/**
 * The row on top, of what holds for everything; its settings come from another store.
 *
 * @param {ValuesOf<"settings"> | null} settings
 * @returns {Item}
 */
export function globalItem(settings) {
  const statuses = settings?.get("statuses") ?? [];
  const error = statuses.find(([, level]) => level === "error");
  const worst = error ?? statuses.find(([, level]) => level === "warn");
  const [status, level, line, remedy] = worst ?? ["", /** @type {const} */ ("ok"), "", null];
  const rate = settings?.get("frame_rate");
  const note = rate === undefined ? "" : `${settings?.get("fixed_frame")}, ${Math.round(rate)} Hz`;
  return {
    id: GLOBAL,
    path: GLOBAL,
    name: "Global Options",
    type: "Global",
    icon: "gear",
    depth: 0,
    can_edit: false,
    level,
    line,
    status,
    remedy: remedy ?? undefined,
    note,
    topics: [],
    enabled: true,
    isActive: true,
    isGroup: false,
    parent: null,
    children: [],
  };
}

/**
 * The displays of the store "displays": `items` from top to bottom, `byId`, and `top`, those in no group.
 *
 * An item has what the store has of it, its `parent` and `children`, whether nothing switches it off
 * (`isActive`), and a `path` of names that is its own and lasts when the viewer starts anew.
 *
 * @param {ValuesOf<"displays">} values
 */
export function arrange(values) {
  /** @type {Model} */
  const model = { items: [], byId: new Map(), top: [] };
  /** @type {Item[]} */
  const above = [];
  /** @type {Set<string>} */
  const paths = new Set();
  for (const id of values.get("order") ?? []) {
    const row = values.get(id);
    if (!row) continue;
    above.length = Math.min(row.depth, above.length);
    const parent = above.at(-1) ?? null;
    const stem = `${parent?.path ?? ""}/${row.name.slice(0, NAME_IN_PATH)}`;
    let path = stem;
    for (let count = 2; paths.has(path); count++) path = `${stem}#${count}`;
    paths.add(path);
    const isActive = row.enabled && (parent?.isActive ?? true);
    /** @type {Item} */
    const item = {
      ...row,
      id,
      parent,
      path,
      isActive,
      isGroup: row.type === "Group",
      children: [],
    };
    siblings(model, item).push(item);
    model.items.push(item);
    model.byId.set(id, item);
    above.push(item);
  }
  return model;
}

/**
 * The siblings of an item: the children of its group, or what is in none.
 *
 * @param {Model} model
 * @param {Item} item
 */
export const siblings = (model, item) => item.parent?.children ?? model.top;

/**
 * The place of an item among its siblings, the first being 1, and their number.
 *
 * @param {Model} model
 * @param {Item} item
 */
export function placeAmong(model, item) {
  const among = siblings(model, item);
  const above = item.parent ? 0 : 1; // the global options
  const position = item.id === GLOBAL ? 1 : among.indexOf(item) + 1 + above;
  return { position, count: among.length + above };
}

/**
 * The item that is selected alone, or else the displays that can be edited together.
 *
 * @param {Item[]} items
 * @param {(id: string) => boolean} isSelected
 */
export function editable(items, isSelected) {
  const chosen = items.filter(({ id }) => isSelected(id));
  return chosen.length > 1 ? chosen.filter((item) => item.can_edit && !item.isGroup) : chosen;
}

/**
 * True if an item is one of a set of ids, or in one.
 *
 * @param {Item} item
 * @param {Set<string>} ids
 * @returns {boolean}
 */
export function isWithin(item, ids) {
  return ids.has(item.id) || (item.parent !== null && isWithin(item.parent, ids));
}

/**
 * The items of a set of ids from top to bottom, without those that are in others of them.
 *
 * @param {Model} model
 * @param {Set<string>} ids
 */
export function topmost(model, ids) {
  return model.items.filter(({ id, parent }) => ids.has(id) && !(parent && isWithin(parent, ids)));
}

/**
 * The items that are rows: not those in folded groups; during a search, what matches.
 *
 * @param {Model} model
 * @param {(item: Item) => boolean} isOpen
 * @param {string} search
 */
export function visible(model, isOpen, search) {
  const words = wordsOf(search);
  if (words.length) return matching(model, words);
  /** @type {Item[]} */
  const rows = [];
  /** @param {Item[]} items */
  const add = (items) => {
    for (const item of items) {
      rows.push(item);
      if (isOpen(item)) add(item.children);
    }
  };
  add(model.top);
  return rows;
}

/**
 * True if all words are somewhere in the name, the type and the topics of an item.
 *
 * @param {Item} item
 * @param {string[]} words
 */
export function matches(item, words) {
  const text = [item.name, item.type, ...item.topics].join("\n").toLowerCase();
  return words.every((word) => text.includes(word));
}

/**
 * With the groups that what matches is in, and all that is in groups that match.
 *
 * @param {Model} model
 * @param {string[]} words
 */
function matching(model, words) {
  /** @type {Set<Item>} */
  const result = new Set();
  for (const item of model.items) {
    const isInShown = item.parent !== null && result.has(item.parent);
    if (!isInShown && !matches(item, words)) continue;
    if (!matches(item, words) && !isInMatch(item, words)) continue;
    /** @type {Item | null} */
    let one = item;
    for (; one; one = one.parent) result.add(one);
  }
  return model.items.filter((item) => result.has(item));
}

/**
 * @param {Item} item
 * @param {string[]} words
 * @returns {boolean}
 */
function isInMatch({ parent }, words) {
  return parent !== null && (matches(parent, words) || isInMatch(parent, words));
}
