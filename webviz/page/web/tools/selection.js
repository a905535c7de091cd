// The selection of this page in the scene. The server knows the same things by the ids that they get
// here, and what there is to say about them.

import { act } from "webviz/act.js";
import * as channel from "webviz/channel.js";
import { listeners } from "webviz/listeners.js";
import { counter } from "webviz/numbers.js";
import { effect, signal, untracked } from "webviz/signals.js";

/** @import {Picked, Selected} from "webviz/types.js" */
/** @import {Commands} from "webviz/messages.js" */
/** @import {ownStore} from "webviz/own_store.js" */

/** @typedef {ReturnType<typeof ownStore<"selected">>} SelectedFacts */

/** The most things that are selected. */
export const MAX_SELECTED = 1000;

const changes = listeners();
const nextId = counter();
/** By id. */
const things = signal(/** @type {Map<number, Selected>} */ (new Map()));
const total = signal(0);
/** The things that the server knows, null before it tells them. */
const facts = signal(/** @type {SelectedFacts | null} */ (null));

/** All things by id: what `pickAt` made of each. */
export const all = () => things.value;
/** The number of things that there were to select. */
export const totalCount = () => total.value;

/**
 * True if a thing moves and stays what it is, such as a frame; messages do not.
 *
 * @param {{id?: number}} pick
 */
export const moves = ({ id }) => facts.value?.get(String(id))?.[1] ?? false;

/** Calls a listener whenever something else is selected; returns what ends it. */
export const onChange = changes.on;

/** @param {SelectedFacts} values the things that the server knows, by id */
export function install(values) {
  facts.value = values;
  effect(() => {
    if (values.all()) untracked(dropUnknown);
  });
  // A server that comes back knows nothing of this page, which gets another id.
  channel.onOpen(() => {
    things.value = new Map();
    total.value = 0;
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
 * @param {number} [count]
 */
export async function change(way, picks, count = picks.length) {
  const old = new Map([...all()].map(([id, thing]) => [keyOf(thing), id]));
  const keep = way === "replace" ? [] : [...all().keys()];
  const fresh = new Map();
  if (way === "remove") {
    const removals = new Set(picks.map((pick) => old.get(keyOf(pick))));
    return put(
      keep.filter((id) => !removals.has(id)),
      fresh,
      0,
    );
  }
  for (const pick of picks) {
    if (way === "add" && old.has(keyOf(pick))) continue;
    if (keep.length + fresh.size >= MAX_SELECTED) break;
    const id = nextId();
    fresh.set(id, { ...pick, id });
  }
  return put(keep, fresh, keep.length + Math.max(count, fresh.size));
}

/**
 * @param {number[]} keep
 * @param {Map<number, Selected>} fresh
 * @param {number} count
 */
async function put(keep, fresh, count) {
  things.value = new Map([...[...all()].filter(([id]) => keep.includes(id)), ...fresh]);
  total.value = Math.max(count, all().size);
  changes.tell();
  const fields = { picks: sendable(fresh.values()), keep, total: total.value };
  const { level, text } = await act("Select", fields, { quiet: true, errors: "caller" });
  // What the server tells of the selection comes before its answer.
  for (const thing of fresh.values()) thing.isKnown = true;
  if (level === "error") drop([...fresh.keys()]);
  else dropUnknown();
  return { level, text };
}

function dropUnknown() {
  drop(
    [...all()]
      .filter(([id, { isKnown }]) => isKnown && !facts.value?.get(String(id)))
      .map(([id]) => id),
  );
}

/** @param {number[]} ids */
function drop(ids) {
  const removals = ids.filter((id) => all().has(id));
  if (!removals.length) return;
  things.value = new Map([...all()].filter(([id]) => !removals.includes(id)));
  total.value -= removals.length;
  changes.tell();
}
