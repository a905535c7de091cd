// State that this browser remembers of its own page: folding, widths, the tab that is open.

const PREFIX = "webviz.";

/**
 * The value remembered under a key, or `otherwise`.
 *
 * @template T
 * @param {string} key
 * @param {T} otherwise
 * @returns {T}
 */
export function recall(key, otherwise) {
  try {
    return JSON.parse(localStorage.getItem(PREFIX + key) ?? "null") ?? otherwise;
  } catch {
    return otherwise; // a browser may forbid it, or hold what another version wrote
  }
}

/**
 * Remembers a value that JSON can hold.
 *
 * @param {string} key
 * @param {unknown} value
 */
export function remember(key, value) {
  try {
    localStorage.setItem(PREFIX + key, JSON.stringify(value));
  } catch {
    // then it lasts as long as the page
  }
}
