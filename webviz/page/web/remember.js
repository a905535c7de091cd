// State that this browser remembers of its own page: folding, widths, the tab that is open; and what
// a tab of the browser remembers when its page is loaded again.

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

const RESUMES = `${PREFIX}resumes`;

/**
 * Lets the next page of this tab begin as the last one of a path ended.
 *
 * @param {string} path
 */
export const resumeAs = (path) => rememberInTab(RESUMES, path);

/** The path whose state this page resumes, "" for none. */
const resumed = recallInTab(RESUMES);
rememberInTab(RESUMES, "");

/** True if this page was here before, and is loaded again. */
const isReloaded = () =>
  /** @type {PerformanceNavigationTiming[]} */ (performance.getEntriesByType("navigation"))[0]
    ?.type === "reload";

// Pages of several viewers may have one origin.
/** @param {string} key */
const keyOfTab = (key, path = location.pathname) => `${PREFIX}${path}.${key}`;

/**
 * The value that `read` had under a key before the page was loaded again, or in the page that it resumes;
 * null after anything else. Its value is stored when this page goes.
 *
 * @template T
 * @param {string} key
 * @param {() => T} read a value that JSON can hold
 * @returns {T | null}
 */
export function surviveReload(key, read) {
  window.addEventListener("pagehide", () => rememberInTab(keyOfTab(key), JSON.stringify(read())));
  if (!resumed && !isReloaded()) return null;
  return JSON.parse(recallInTab(keyOfTab(key, resumed || undefined)) || "null");
}

/**
 * The text that this tab of the browser remembers under a key, "" for none.
 *
 * @param {string} key
 */
export function recallInTab(key) {
  try {
    return sessionStorage.getItem(key) ?? "";
  } catch {
    return ""; // a browser may forbid it
  }
}

/**
 * Remembers a text in this tab of the browser.
 *
 * @param {string} key
 * @param {string} text
 */
export function rememberInTab(key, text) {
  try {
    sessionStorage.setItem(key, text);
  } catch {
    // then it lasts as long as the page
  }
}
