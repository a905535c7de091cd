// The line below the toolbar: what to do, where the pointer is, and what came of it.

import { el } from "webviz/dom.js";
import { effect, owned, signal, untracked } from "webviz/signals.js";

/** @type {Partial<Record<string, number>>} */
const SHOWN_MS = { ok: 5000, warn: 10000, error: 10000 };

const resting = signal({ level: "hint", text: "" });
const current = signal(resting.value);

export const hint = el(
  "output",
  {
    class: "wv-hint wv-card",
    hidden: () => !current.value.text,
    "data-level": () => current.value.level,
  },
  () => current.value.text,
);

effect(() => {
  const ms = SHOWN_MS[current.value.level];
  if (!ms) return;
  const timer = setTimeout(() => showLiveHint(""), ms);
  owned(() => clearTimeout(timer));
});

/**
 * Shows a sentence: a "hint" while a tool is active, or "ok", "warn" or "error" for a while.
 *
 * @param {string} level
 * @param {string} text
 */
export function showHint(level, text) {
  const message = { level, text };
  current.value = message;
  if (level === "hint") resting.value = message;
}

/**
 * Shows where a gesture is, until another text; "" shows the hint again.
 *
 * @param {string} text
 */
export function showLiveHint(text) {
  current.value = text ? { level: "hint", text } : untracked(() => resting.value);
}
