// The line below the toolbar: what to do, where the pointer is, and what came of it.

import { el } from "webviz/dom.js";
import { effect, owned, signal, untracked } from "webviz/signals.js";

/** @type {Partial<Record<string, number>>} */
const SHOWN_MS = { ok: 5000, warn: 10000, error: 10000 };

const resting = signal({ level: "hint", text: "" });
const shown = signal(resting.value);

export const hint = el(
  "output",
  {
    class: "wv-hint wv-card",
    hidden: () => !shown.value.text,
    "data-level": () => shown.value.level,
  },
  () => shown.value.text,
);

effect(() => {
  const ms = SHOWN_MS[shown.value.level];
  if (!ms) return;
  const timer = setTimeout(() => tellLive(""), ms);
  owned(() => clearTimeout(timer));
});

/**
 * Shows a sentence: a "hint" while a tool is active, or "ok", "warn" or "error" for a while.
 *
 * @param {string} level
 * @param {string} text
 */
export function tell(level, text) {
  const said = { level, text };
  shown.value = said;
  if (level === "hint") resting.value = said;
}

/**
 * Shows where a gesture is, until another text; "" shows the hint again.
 *
 * @param {string} text
 */
export function tellLive(text) {
  shown.value = text ? { level: "hint", text } : untracked(() => resting.value);
}
