// The clipboard, also where a page may not use it: without HTTPS, from another machine.

import { el } from "webviz/dom.js";
import { toast } from "webviz/toasts.js";

export const NOT_COPIED =
  "This browser does not allow copying. Allow the clipboard for this page in the browser's settings.";

/**
 * Copies a text; whether that was possible.
 *
 * @param {string} text
 */
export async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const before = /** @type {HTMLElement | null} */ (document.activeElement);
    const field = el("textarea", { style: "position: fixed; opacity: 0" });
    field.value = text;
    document.body.append(field);
    field.select();
    const isCopied = document.execCommand("copy");
    field.remove();
    before?.focus({ preventScroll: true });
    return isCopied;
  }
}

/**
 * Copies a text, and tells that it is copied, or that this is not possible.
 *
 * @param {string} text
 * @param {string} [confirmation] a sentence
 */
export async function copyAndTell(text, confirmation = "Copied.") {
  if (await copy(text)) toast(confirmation);
  else toast(NOT_COPIED, { level: "error" });
}
