// Values that know what reads them. Where one is read in an effect, the effect runs again when the
// value changes, and so the page follows its data without comparing them.
//
// Effects run before the write returns, or at the end of the outermost `batch`; each at most once for
// all that was written. What they make belongs to them: effects that were made inside are ended first.

/** @typedef {import("webviz/types.js").End} End */

/**
 * A thing with a value that can be read.
 *
 * @template T
 * @typedef {Source & {readonly value: T}} Readable
 */

const MAX_ROUNDS = 100; // effects that write what they read themselves would never come to rest

/** The state of now: who reads, who owns what is made, and which effects are due. */
const now = {
  /** @type {Reader | null} */
  reader: null,
  /** @type {Owner | null} */
  owner: null,
  batches: 0,
  writes: 0,
  /** @type {Set<Effect>} */
  due: new Set(),
};

/** A thing that can be read: it counts its changes, and knows the effects and computed values that read it. */
export class Source {
  version = 0;
  /** @type {Set<Reader>} */
  readers = new Set();

  /** Notes that this is read. */
  track() {
    now.reader?.note(this);
  }

  /** Brings the version up to date. */
  refresh() {}

  /** @param {Reader} reader that runs again when this changes */
  join(reader) {
    this.readers.add(reader);
  }

  /** @param {Reader} reader */
  leave(reader) {
    this.readers.delete(reader);
  }

  /** This has changed. */
  touch() {
    this.version += 1;
    now.writes += 1;
    for (const reader of this.readers) reader.stale();
    flush();
  }
}

/**
 * A value that is written, see `signal`.
 *
 * @template T
 */
export class Signal extends Source {
  #value;

  /** @param {T} value */
  constructor(value) {
    super();
    this.#value = value;
  }

  get value() {
    this.track();
    return this.#value;
  }

  set value(next) {
    if (Object.is(next, this.#value)) return;
    this.#value = next;
    this.touch();
  }
}

/** A function that reads: it remembers what it has read, and in which version. */
export class Reader extends Source {
  /** @type {Map<Source, number>} */
  #sources = new Map();
  #isLive = false;

  /** Something has changed of what was read, while this is live. */
  stale() {}

  /** @param {Source} source */
  note(source) {
    if (this.#sources.has(source)) return;
    this.#sources.set(source, source.version);
    if (this.#isLive) source.join(this);
  }

  /**
   * @template T
   * @param {() => T} make
   * @param {Owner | null} owner
   * @returns {T}
   */
  read(make, owner) {
    const before = this.#sources;
    this.#sources = new Map();
    try {
      return within(this, owner, make);
    } finally {
      for (const source of before.keys()) if (!this.#sources.has(source)) source.leave(this);
    }
  }

  hasChanges() {
    for (const [source, version] of this.#sources) {
      source.refresh();
      if (source.version !== version) return true;
    }
    return false;
  }

  /** @param {boolean} isLive whether it is called when something has changed */
  live(isLive) {
    this.#isLive = isLive;
    for (const source of this.#sources.keys()) source[isLive ? "join" : "leave"](this);
  }
}

/**
 * A value made of others, see `computed`. What it reads knows it only while it is read itself.
 *
 * @template T
 */
class Computed extends Reader {
  #make;
  #writes = -1;
  /** @type {{value?: T, error?: unknown}} */
  #result = {};

  /** @param {() => T} make */
  constructor(make) {
    super();
    this.#make = make;
  }

  get value() {
    this.refresh();
    this.track();
    if ("error" in this.#result) throw this.#result.error;
    return /** @type {T} */ (this.#result.value);
  }

  refresh() {
    if (this.#writes === now.writes) return;
    this.#writes = now.writes;
    if (this.version && !this.hasChanges()) return;
    const before = this.#result;
    try {
      this.#result = { value: this.read(this.#make, null) };
    } catch (error) {
      this.#result = { error };
    }
    const isSame = "value" in before && Object.is(before.value, this.#result.value);
    if (!isSame || "error" in this.#result) this.version += 1;
  }

  stale() {
    for (const reader of this.readers) reader.stale();
  }

  /** @param {Reader} reader */
  join(reader) {
    if (!this.readers.size) this.live(true);
    super.join(reader);
  }

  /** @param {Reader} reader */
  leave(reader) {
    super.leave(reader);
    if (!this.readers.size) this.live(false);
  }
}

/** Ends what was made in it. */
class Owner {
  /** @type {number} */
  depth = (now.owner?.depth ?? 0) + 1;
  /** @type {Set<End>} */
  ends = new Set();

  end() {
    for (const end of [...this.ends].reverse()) end();
  }
}

class Effect extends Reader {
  #run;
  #isEnded = false;
  owner = new Owner();

  /** @param {() => void} run */
  constructor(run) {
    super();
    this.#run = run;
    this.live(true);
  }

  stale() {
    now.due.add(this);
  }

  run() {
    this.owner.end();
    batch(() => this.read(this.#run, this.owner));
    if (this.#isEnded) this.owner.end();
  }

  refresh() {
    if (!this.#isEnded && this.hasChanges()) this.run();
  }

  end() {
    this.#isEnded = true;
    this.live(false);
    this.owner.end();
  }
}

/**
 * @template T
 * @param {Reader | null} reader
 * @param {Owner | null} owner
 * @param {() => T} make
 * @returns {T}
 */
function within(reader, owner, make) {
  const before = { reader: now.reader, owner: now.owner };
  Object.assign(now, { reader, owner });
  try {
    return make();
  } finally {
    Object.assign(now, before);
  }
}

/** Runs the effects that are due, the outer ones first; an error of one is reported, and others go on. */
function flush() {
  if (now.batches || !now.due.size) return;
  now.batches += 1;
  for (let round = 0; now.due.size; round++) {
    const due = [...now.due].sort((a, b) => a.owner.depth - b.owner.depth);
    now.due.clear();
    for (const effect of due) {
      try {
        if (round === MAX_ROUNDS) throw new Error("An effect keeps changing its own inputs.");
        effect.refresh();
      } catch (error) {
        console.error(error);
      }
    }
  }
  now.batches -= 1;
}

/**
 * A value that can be read and written: `.value`.
 *
 * @template T
 * @param {T} value
 */
export const signal = (value) => new Signal(value);

/**
 * A value made of others, anew when it is read after they have changed: `.value`. What `make` throws,
 * reading it throws.
 *
 * @template T
 * @param {() => T} make
 * @returns {Readable<T>}
 */
export const computed = (make) => new Computed(make);

/**
 * Runs a function now and whenever something changes that it has read, until the returned function
 * is called or what it was made in ends. What it throws the first time, this throws.
 *
 * @param {() => void} run
 * @returns {End}
 */
export function effect(run) {
  const instance = new Effect(run);
  const end = owned(() => instance.end());
  try {
    instance.run();
  } catch (error) {
    end();
    throw error;
  }
  return end;
}

/**
 * Has a function called when the effect or root ends, or runs again, in which this is called; returns
 * what calls it before.
 *
 * @param {End} end
 * @returns {End}
 */
export function owned(end) {
  const { owner } = now;
  const once = () => {
    owner?.ends.delete(once);
    end();
  };
  owner?.ends.add(once);
  return once;
}

/**
 * Calls `make(end)`, and returns what it does; effects made in it last until `end()` is called,
 * wherever it is called from.
 *
 * @template T
 * @param {(end: End) => T} make
 * @returns {T}
 */
export function root(make) {
  const owner = new Owner();
  try {
    return within(null, owner, () => make(() => owner.end()));
  } catch (error) {
    owner.end();
    throw error;
  }
}

/**
 * Lets effects wait until all is written.
 *
 * @template T
 * @param {() => T} write
 * @returns {T}
 */
export function batch(write) {
  now.batches += 1;
  try {
    return write();
  } finally {
    now.batches -= 1;
    flush();
  }
}

/**
 * Reads without being told of changes.
 *
 * @template T
 * @param {() => T} read
 * @returns {T}
 */
export const untracked = (read) => within(null, now.owner, read);

/**
 * Makes rows by `makeRow(item, key)`, in the order of the items of a list: a child for `el`.
 * Rows are made once for each key, and end when their key goes; `item` is a signal.
 *
 * @template T
 * @template {string | number} K
 * @template R
 * @param {() => Iterable<T>} list
 * @param {(item: T) => K} keyOf
 * @param {(item: Signal<T>, key: K) => R} makeRow
 * @returns {() => R[]}
 */
export function each(list, keyOf, makeRow) {
  /** @type {Map<K, {item: Signal<T>, result: R, end: End}>} */
  const rows = new Map();
  owned(() => rows.forEach(({ end }) => end()));
  return () => {
    const items = new Map([...list()].map((item) => [keyOf(item), item]));
    for (const [key, { end }] of rows) {
      if (items.has(key)) continue;
      rows.delete(key);
      end();
    }
    return [...items].map(([key, value]) => {
      const row = rows.get(key) ?? root((end) => add(value, key, end));
      row.item.value = value;
      return row.result;
    });
  };

  /**
   * @param {T} value
   * @param {K} key
   * @param {End} end
   */
  function add(value, key, end) {
    const item = signal(value);
    const row = { item, result: makeRow(item, key), end };
    rows.set(key, row);
    return row;
  }
}
