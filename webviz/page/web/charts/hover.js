// The time that the pointer is at, shared by all charts of a page, and seeks to it.

/** @typedef {(time: number | null) => void} Listener */

/** @type {Set<Listener>} */
const listeners = new Set();

/** @param {number | null} time in ROS seconds, null for none */
export function hover(time) {
  for (const listener of listeners) listener(time);
}

/**
 * Calls `listener` with each time that the pointer is at; returns what ends that.
 *
 * @param {Listener} listener
 */
export function onHover(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/**
 * A function that sends times one at a time: while one is under way, only the newest is kept.
 *
 * @param {(time: number) => unknown} send
 */
export function seeking(send) {
  /** @type {number | null} */
  let wanted = null;
  let isUnderway = false;
  return async (/** @type {number} */ time) => {
    wanted = time;
    if (isUnderway) return;
    isUnderway = true;
    while (wanted !== null) {
      const next = wanted;
      wanted = null;
      await send(next);
    }
    isUnderway = false;
  };
}
