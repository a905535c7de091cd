// The gestures of tools by name, of the page and of plug-ins.

import { listeners } from "webviz/listeners.js";

/** @import {Gesture, MadeGesture, ViewerTool} from "webviz/types.js" */

/** @type {Map<string, Gesture>} */
const factories = new Map();
const changes = listeners();

/**
 * Adds a gesture. `make(tool, done)` returns what a tool of the registry has besides its name:
 * `pointer(event)`, `hint`, `cursor`, `select()`, `leave()`; `done({points, yaw, keys})` is to be
 * called with each finished one.
 *
 * @param {string} name
 * @param {Gesture} make
 */
export function gesture(name, make) {
  factories.set(name, make);
  changes.tell();
}

/** @param {string} name */
export const gestureOf = (name) => factories.get(name);

/** Calls a listener whenever there is another gesture. */
export const onGesture = changes.on;
