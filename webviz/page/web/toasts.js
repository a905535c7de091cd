// Short messages over the scene, which go by themselves. The pointer goes through them.

import { el, set, setText } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { signal, untracked } from "webviz/signals.js";

/**
 * @typedef {{
 *   count: number, timer: ReturnType<typeof setTimeout> | 0, run: (() => unknown) | undefined, element: HTMLElement,
 *   text: HTMLElement, button: HTMLElement, remove: () => void,
 * }} Toast
 */

/** @type {Record<string, number>} */
const SHOWN_MS = { ok: 5000, warn: 10000, error: 10000 };
const MAX_SHOWN = 3;

/** @type {Map<string, Toast>} */
const toasts = new Map();
const place = signal(/** @type {HTMLElement | null} */ (null));

/** @param {HTMLElement} scene */
export function install(scene) {
  const element = el("div", { class: "wv-toasts", role: "status", "aria-live": "polite" });
  scene.append(element);
  place.value = element;
}

/**
 * Shows a sentence with a level, "ok", "warn" or "error", and perhaps an action: `{label, run}`.
 * It replaces the one about the same topic; without a topic, repetitions of a sentence are counted.
 * Returns what takes it away.
 *
 * @param {string} text
 * @param {{
 *   level?: string, action?: {label: string, run: () => unknown} | null, topic?: string,
 * }} [options]
 */
export function toast(text, { level = "ok", action = null, topic = "" } = {}) {
  const home = untracked(() => place.value);
  if (!home) return () => {};
  const key = topic || `${level} ${text}`;
  const one = toasts.get(key) ?? make(home, key);
  one.count += topic ? 0 : 1;
  set(one.element, { "data-level": level });
  setText(one.text, one.count > 1 ? `${text} (${one.count})` : text);
  one.button.hidden = !action;
  setText(one.button, action?.label ?? "");
  one.run = action?.run;
  clearTimeout(one.timer);
  one.timer = setTimeout(one.remove, SHOWN_MS[level]);
  for (const old of [...toasts.values()].slice(0, -MAX_SHOWN)) old.remove();
  return one.remove;
}

/**
 * @param {HTMLElement} place
 * @param {string} key
 * @returns {Toast}
 */
function make(place, key) {
  const remove = () => {
    clearTimeout(one.timer);
    if (toasts.get(key) === one) toasts.delete(key);
    one.element.remove();
  };
  const act = () => {
    remove();
    one.run?.();
  };
  const text = el("span");
  const button = el("button", { type: "button", class: "wv-link", onclick: act });
  const parts = [text, button, iconButton("close", "Dismiss", remove, { tip: null })];
  const element = el("div", { class: "wv-toast" }, parts);
  /** @type {Toast} */
  const one = { count: 0, timer: 0, run: undefined, element, text, button, remove };
  toasts.set(key, one);
  place.append(one.element);
  return one;
}
