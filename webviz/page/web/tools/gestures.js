// The gestures of tools by name, of the page and of plug-ins.

/** @import {Gesture, MadeGesture, ViewerTool} from "../types.js" */

/** @type {Map<string, Gesture>} */
const makers = new Map();
/** @type {Set<() => void>} */
const listeners = new Set();

/**
 * Adds a gesture. `make(tool, done)` returns what a tool of the registry has besides its name:
 * `pointer(event)`, `hint`, `cursor`, `select()`, `leave()`; `done({points, yaw, keys})` is to be
 * called with each finished one.
 *
 * @param {string} name
 * @param {Gesture} make
 */
export function gesture(name, make) {
  makers.set(name, make);
  for (const listener of listeners) listener();
}

/** @param {string} name */
export const gestureOf = (name) => makers.get(name);

/**
 * Calls `listener` whenever there is another gesture.
 *
 * @param {() => void} listener
 */
export const onGesture = (listener) => listeners.add(listener);
