// The gestures of tools by name, of the page and of plug-ins.

const makers = new Map();
const listeners = new Set();

/**
 * Adds a gesture. `make(tool, done)` returns what a tool of the registry has besides its name:
 * `pointer(event)`, `hint`, `cursor`, `select()`, `leave()`; `done({points, yaw, keys})` is to be
 * called with each finished one.
 */
export function gesture(name, make) {
  makers.set(name, make);
  for (const listener of listeners) listener();
}

export const gestureOf = (name) => makers.get(name);

/** Calls `listener` whenever there is another gesture. */
export const onGesture = (listener) => listeners.add(listener);
