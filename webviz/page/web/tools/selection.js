// The selection of this page in the scene. The server knows the same things by the ids that they get
// here, and what there is to say about them.

import { act } from "webviz/act.js";
import * as channel from "webviz/channel.js";
import { listeners } from "webviz/listeners.js";
import { watch } from "webviz/stores.js";

/** @import {Picked, Selected, ValuesOf} from "webviz/types.js" */
/** @import {Commands} from "webviz/messages.js" */

/** The most things that are selected. */
export const MAX_SELECTED = 1000;

const changes = listeners();
/** @type {Map<number, Selected>} */
let things = new Map(); // by id
let total = 0;
let count = 0;
/** @type {ValuesOf<"selected">} */
let known = new Map();
/** @type {() => void} */
let end = () => {};

/** All things by id: what `pickAt` made of each. */
export const all = () => things;
/** The number of things that there were to select. */
export const totalCount = () => total;

/**
 * True if a thing moves and stays what it is, such as a frame; messages do not.
 *
 * @param {{id?: number}} pick
 */
export const moves = ({ id }) => known.get(String(id))?.[1] ?? false;

/** Calls a listener whenever something else is selected; returns what ends it. */
export const onChange = changes.on;

// A server that comes back knows nothing of this page, which gets another id.
export function install() {
  channel.onOpen(() => {
    things = new Map();
    total = 0;
    known = new Map();
    end();
    end = watch(`selected:${window.webviz.browser}`, (values) => {
      known = values;
      dropUnknown();
    });
    changes.tell();
  });
}

/**
 * The identity of a `pickAt`, to compare it with others.
 *
 * @param {Picked} pick
 */
const keyOf = ({ group, key, number, at }) => JSON.stringify([group, key, number, at]);

/**
 * The same as the server reads it: of one node, its items.
 *
 * @param {Iterable<Selected>} picks
 */
export function sendable(picks) {
  const nodes = new Map();
  for (const { id, group, key, number, at, color } of picks) {
    const name = JSON.stringify([group, key]);
    if (!nodes.has(name)) nodes.set(name, { group, key, items: [] });
    nodes.get(name).items.push([id, number, at, color]);
  }
  return [...nodes.values()];
}

/**
 * Selects what was picked, in a way: "replace", "add" or "remove". Resolves with what is to be said
 * about it, `{level, text}`.
 *
 * @param {"replace" | "add" | "remove"} way
 * @param {Picked[]} picks
 * @param {number} [found]
 */
export async function change(way, picks, found = picks.length) {
  const old = new Map([...things].map(([id, thing]) => [keyOf(thing), id]));
  const keep = way === "replace" ? [] : [...things.keys()];
  const fresh = new Map();
  if (way === "remove") {
    const gone = new Set(picks.map((pick) => old.get(keyOf(pick))));
    return put(
      keep.filter((id) => !gone.has(id)),
      fresh,
      0,
    );
  }
  for (const pick of picks) {
    if (way === "add" && old.has(keyOf(pick))) continue;
    if (keep.length + fresh.size >= MAX_SELECTED) break;
    count += 1;
    fresh.set(count, { ...pick, id: count });
  }
  return put(keep, fresh, keep.length + Math.max(found, fresh.size));
}

/**
 * @param {number[]} keep
 * @param {Map<number, Selected>} fresh
 * @param {number} wanted
 */
async function put(keep, fresh, wanted) {
  things = new Map([...[...things].filter(([id]) => keep.includes(id)), ...fresh]);
  total = Math.max(wanted, things.size);
  changes.tell();
  const fields = { picks: sendable(fresh.values()), keep, total };
  const { level, text } = await act("Select", fields, { quiet: true, errors: "caller" });
  // What the server tells of the selection comes before its answer.
  for (const thing of fresh.values()) thing.isKnown = true;
  if (level === "error") drop([...fresh.keys()]);
  else dropUnknown();
  return { level, text };
}

function dropUnknown() {
  drop(
    [...things].filter(([id, { isKnown }]) => isKnown && !known.has(String(id))).map(([id]) => id),
  );
}

/** @param {number[]} ids */
function drop(ids) {
  const gone = ids.filter((id) => things.delete(id));
  total -= gone.length;
  if (gone.length) changes.tell();
}
