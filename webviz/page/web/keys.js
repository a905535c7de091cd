// Names of keys, for people.

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
