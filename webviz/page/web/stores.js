// Values by key that the server keeps the same here, of what this page watches.

import * as channel from "./channel.js";

/** @import {ValuesOf} from "./types.js" */

/** @type {Map<string, {values: Map<string, any>, listeners: Set<Function>, isThere: boolean}>} */
const stores = new Map();

channel.onOpen(() => {
  for (const name of stores.keys()) channel.send({ type: "Watch", store: name });
});

channel.on("Values", ({ store: name, all, set, gone }) => {
  const store = stores.get(name);
  if (!store) return;
  const changed = new Set([...Object.keys(set), ...gone]);
  if (all) {
    for (const key of store.values.keys()) changed.add(key);
    store.values.clear();
  }
  for (const key of gone) store.values.delete(key);
  for (const [key, value] of Object.entries(set)) store.values.set(key, value);
  store.isThere = true;
  for (const listener of [...store.listeners]) listener(store.values, changed);
});

/**
 * Calls `listener(values, changed)` with all values, a Map, and the set of keys that are new, changed
 * or gone: at once if they are there, and whenever something changes. Returns what ends it.
 *
 * @template {string} N
 * @param {N} name
 * @param {(values: ValuesOf<N>, changed: Set<string>) => void} listener
 */
export function watch(name, listener) {
  let store = stores.get(name);
  if (!store) {
    stores.set(name, (store = { values: new Map(), listeners: new Set(), isThere: false }));
    if (channel.isOpen()) channel.send({ type: "Watch", store: name });
  }
  store.listeners.add(listener);
  if (store.isThere) listener(store.values, new Set(store.values.keys()));
  return () => {
    store.listeners.delete(listener);
    if (store.listeners.size || stores.get(name) !== store) return;
    stores.delete(name);
    if (channel.isOpen()) channel.send({ type: "Unwatch", store: name });
  };
}
