// The time that the pointer is at, shared by all charts of a page.

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
