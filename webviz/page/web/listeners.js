// Listeners, which are called when something has changed.

/** Returns `{on(listener), tell()}`: `on` adds one, and returns what ends it; `tell` calls all. */
export function listeners() {
  /** @type {Set<() => void>} */
  const all = new Set();
  return {
    /** @param {() => void} listener */
    on(listener) {
      all.add(listener);
      return () => all.delete(listener);
    },
    tell() {
      for (const listener of [...all]) if (all.has(listener)) listener();
    },
  };
}
