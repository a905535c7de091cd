// Names of keys, and what they do in parts of the page; see commands.js for all of it.

/**
 * Something that keys, or the mouse, do in a part of the page: `does` is for people, `keys` are in the words of
 * `keyOf`, and `unnamed` others that do the same. `run` may return false if it does nothing now.
 * Without it, the scene or another part sees to that.
 *
 * @template C
 * @typedef {{
 *   does: string, keys: string[], unnamed?: string[],
 *   run?: (context: C, event: KeyboardEvent) => unknown,
 * }} Shortcut
 */

/** A function that may take a key, and says whether it did. @typedef {(event: KeyboardEvent) => boolean} Taker */

const isMac = /Mac|iPhone|iPad/.test(navigator.platform);
const ARROWS = { ArrowUp: "↑", ArrowDown: "↓", ArrowLeft: "←", ArrowRight: "→" };
/** @type {Record<string, string>} */
const NAMES = { Escape: "Esc", " ": "Space", ...ARROWS };

/**
 * A key as people read it: "Ctrl+Shift+S" of "Ctrl+Shift+s"; Ctrl is the command key of a Mac.
 *
 * @param {string} key
 */
export function keyText(key) {
  const parts = key.length > 1 ? key.split("+") : [key];
  const last = parts.pop() ?? "";
  const name = NAMES[last] ?? (last.length === 1 ? last.toUpperCase() : last);
  return [...parts.map((part) => (part === "Ctrl" && isMac ? "⌘" : part)), name].join("+");
}

/**
 * The key that an event is about, as commands name it: "Ctrl+Shift+s", "g", "?", "Delete".
 *
 * @param {Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "altKey" | "shiftKey">} event
 */
export function keyOf(event) {
  const { key } = event;
  const name = key.length === 1 ? key.toLowerCase() : key;
  const isLetter = /^[a-z]$/.test(name) || name.length > 1;
  return [
    event.ctrlKey || event.metaKey ? "Ctrl" : null,
    event.altKey ? "Alt" : null,
    // "?" is what is written on the key; which others it takes to type it differs.
    event.shiftKey && isLetter ? "Shift" : null,
    name,
  ]
    .filter(Boolean)
    .join("+");
}

/** @type {Set<Taker>} */
const drags = new Set();
/** @type {WeakMap<EventTarget, Taker>} */
const parts = new WeakMap();
/** @type {Map<string, Shortcut<any>[]>} */
const groups = new Map();

/**
 * Lets `take(event)` have keys before everything else, as while something is dragged. Returns what
 * ends it.
 *
 * @param {Taker} take
 */
export function takeKeysFirst(take) {
  drags.add(take);
  return () => drags.delete(take);
}

/**
 * Lets `take(event)` have the keys of an element that has the focus, or in which it is.
 *
 * @param {EventTarget} element
 * @param {Taker} take
 */
export const takeKeysOf = (element, take) => parts.set(element, take);

/**
 * Adds a group to the table of keys; returns what does its part, `take(context, event)`: whether there
 * was something to do.
 *
 * @template C
 * @param {string} group
 * @param {Shortcut<C>[]} all
 */
export function shortcuts(group, all) {
  groups.set(group, all);
  const byKey = new Map(
    all.flatMap(({ keys, unnamed = [], run }) =>
      run ? [...keys, ...unnamed].map((key) => /** @type {const} */ ([key, run])) : [],
    ),
  );
  return (/** @type {C} */ context, /** @type {KeyboardEvent} */ event) => {
    const run = byKey.get(keyOf(event));
    return run !== undefined && run(context, event) !== false;
  };
}

/** All groups of shortcuts of parts. */
export const shortcutGroups = () => groups;

/**
 * True if something that is dragged takes a key.
 *
 * @param {KeyboardEvent} event
 */
export const takesDrag = (event) => [...drags].some((take) => take(event));

/**
 * True if a part of the page takes a key: the innermost around what has the focus.
 *
 * @param {KeyboardEvent} event
 */
export const takesPart = (event) => event.composedPath().some((each) => parts.get(each)?.(event));
