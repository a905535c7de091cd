// Files of the browser.

import { el } from "webviz/dom.js";

/**
 * Saves a text as a file with this name.
 *
 * @param {string} name
 * @param {string} text
 */
export const download = (name, text) => save(name, new Blob([text]));

/**
 * Saves bytes as a file with this name.
 *
 * @param {string} name
 * @param {Blob} blob
 */
export function save(name, blob) {
  const link = el("a", { download: name, href: URL.createObjectURL(blob) });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
