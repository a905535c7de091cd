// The line below the toolbar: what to do, where the pointer is, and what came of it.

import { el, set, setText } from "webviz/dom.js";

/** @type {Partial<Record<string, number>>} */
const SHOWN_MS = { ok: 5000, warn: 10000, error: 10000 };

export const hint = el("output", { class: "wv-hint wv-card", hidden: true });

let timer = 0;
let resting = "";

/**
 * Shows a sentence: a "hint" while a tool is active, or "ok", "warn" or "error" for a while.
 *
 * @param {string} level
 * @param {string} text
 */
export function tell(level, text) {
  clearTimeout(timer);
  if (level === "hint") resting = text;
  show(level, text);
  if (SHOWN_MS[level]) timer = setTimeout(() => show("hint", resting), SHOWN_MS[level]);
}

/**
 * Shows where a gesture is, until another text; "" shows the hint again.
 *
 * @param {string} text
 */
export function tellLive(text) {
  clearTimeout(timer);
  show("hint", text || resting);
}

/**
 * @param {string} level
 * @param {string} text
 */
function show(level, text) {
  set(hint, { "data-level": level });
  setText(hint, text);
  if (hint.hidden !== (text === "")) hint.hidden = text === "";
}
