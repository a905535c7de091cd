// Texts as files of the browser.

import { el } from "./dom.js";

/**
 * Saves a text as a file with this name.
 *
 * @param {string} name
 * @param {string} text
 */
export function download(name, text) {
  const link = el("a", { download: name, href: URL.createObjectURL(new Blob([text])) });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
