// Values by key that the server keeps the same here, of what this page reads.

import * as channel from "webviz/channel.js";
import { batch, Source, untracked } from "webviz/signals.js";

/** @import {Reader} from "webviz/signals.js" */
/** @import {End, Named, StoreReader, ValuesOf} from "webviz/types.js" */

/** @type {Map<string, Store>} */
const stores = new Map();

channel.onOpen(() => {
  for (const store of stores.values()) store.open();
});

channel.on("Values", ({ store, ...values }) => stores.get(store)?.take(values));

/** The value of a key, or all: while an effect reads it, the server sends it. */
class Part extends Source {
  /** @param {Store} store */
  constructor(store) {
    super();
    this.store = store;
  }

  /** @param {Reader} reader */
  join(reader) {
    if (!this.readers.has(reader)) this.store.hold();
    super.join(reader);
  }

  /** @param {Reader} reader */
  leave(reader) {
    if (this.readers.has(reader)) this.store.release();
    super.leave(reader);
  }
}

class Store {
  #name;
  /** @type {Map<string, any>} */
  #values = new Map();
  /** @type {Map<string, Part>} */
  #parts = new Map();
  #all = new Part(this);
  #presence = new Part(this);
  #holders = 0;
  #isWatched = false;
  #isThere = false;
  /** @type {Set<(values: any, changed: Set<string>) => void>} */
  #listeners = new Set();

  /** @param {string} name */
  constructor(name) {
    this.#name = name;
  }

  /** @param {string} key */
  get(key) {
    this.#part(key).track();
    return this.#values.get(key);
  }

  /** @param {string} key */
  has(key) {
    this.#part(key).track();
    return this.#values.has(key);
  }

  /** All values, a Map: for what depends on each of them. */
  all() {
    this.#all.track();
    return this.#values;
  }

  /** True once the values have come. */
  isThere() {
    this.#presence.track();
    return this.#isThere;
  }

  /** @param {string} key */
  #part(key) {
    const part = this.#parts.get(key) ?? new Part(this);
    this.#parts.set(key, part);
    return part;
  }

  hold() {
    this.#holders += 1;
    if (this.#isWatched) return;
    this.#isWatched = true;
    this.open();
  }

  /** Values that are read again at once, as by an effect that runs again, are not sent anew. */
  release() {
    this.#holders -= 1;
    queueMicrotask(() => {
      if (this.#holders || !this.#isWatched) return;
      this.#keep({ all: true, set: {}, gone: [] });
      this.#isWatched = this.#isThere = false;
      if (channel.isOpen()) channel.send({ type: "Unwatch", store: this.#name });
    });
  }

  /** The channel has been opened, or this is watched from now on. */
  open() {
    if (this.#isWatched && channel.isOpen()) channel.send({ type: "Watch", store: this.#name });
  }

  /**
   * Takes what the server has sent, but for what was under way before this was watched anew: that is
   * for values which are gone.
   *
   * @param {{all: boolean, set: Record<string, any>, gone: string[]}} values
   */
  take(values) {
    if (this.#isWatched && (this.#isThere || values.all)) this.#keep(values);
  }

  /** @param {{all: boolean, set: Record<string, any>, gone: string[]}} values */
  #keep({ all, set, gone }) {
    const changed = new Set([...Object.keys(set), ...gone]);
    if (all) {
      for (const key of this.#values.keys()) changed.add(key);
      this.#values.clear();
    }
    for (const key of gone) this.#values.delete(key);
    for (const [key, value] of Object.entries(set)) this.#values.set(key, value);
    const isNew = !this.#isThere;
    this.#isThere = true;
    batch(() => this.#tell(changed, isNew));
  }

  /**
   * @param {Set<string>} changed
   * @param {boolean} isNew
   */
  #tell(changed, isNew) {
    if (isNew) this.#presence.touch();
    if (changed.size || isNew) this.#all.touch();
    for (const key of changed) {
      const part = this.#parts.get(key);
      part?.touch();
      if (!this.#values.has(key) && !part?.readers.size) this.#parts.delete(key);
    }
    for (const listener of [...this.#listeners]) listener(this.#values, changed);
  }

  /**
   * @param {(values: any, changed: Set<string>) => void} listener
   * @returns {End}
   */
  watch(listener) {
    this.#listeners.add(listener);
    this.hold();
    if (this.#isThere) untracked(() => listener(this.#values, new Set(this.#values.keys())));
    return () => {
      if (this.#listeners.delete(listener)) this.release();
    };
  }
}

/** @param {string} name */
function storeOf(name) {
  const entry = stores.get(name) ?? new Store(name);
  stores.set(name, entry);
  return entry;
}

/**
 * A store to read from in effects: the server sends its values while one reads them. What has not
 * come yet is undefined.
 *
 * @template {string} N
 * @param {N} name
 * @returns {StoreReader<Named<N>>}
 */
export const store = (name) => storeOf(name);

/**
 * Calls `listener(values, changed)` with all values, a Map, and the set of keys that are new, changed
 * or gone: at once if they are there, and whenever something changes. Returns what ends it.
 *
 * @template {string} N
 * @param {N} name
 * @param {(values: ValuesOf<N>, changed: Set<string>) => void} listener
 */
export const watch = (name, listener) => storeOf(name).watch(listener);

/**
 * The present state of a store, read from its values.
 *
 * @template {string} N
 * @template T
 * @param {N} store
 * @param {(values: ValuesOf<N>) => T} read
 * @returns {Promise<T>}
 */
export function once(store, read) {
  return new Promise((resolve) => {
    const end = watch(store, (values) => {
      resolve(read(values));
      queueMicrotask(() => end());
    });
  });
}
