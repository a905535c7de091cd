// Short messages over the scene, which go by themselves. The pointer goes through them.

import { el, set, setText } from "../dom.js";
import { icon } from "../icons.js";

const SHOWN_MS = { ok: 5000, warn: 10000, error: 10000 };
const MAX_SHOWN = 3;

const shown = new Map();
let place = null;

export function install(scene) {
  place = el("div", { class: "wv-toasts", role: "status", "aria-live": "polite" });
  scene.append(place);
}

/**
 * Shows a sentence with a level, "ok", "warn" or "error", and perhaps an action: `{label, run}`.
 * It replaces the one about the same topic; without a topic, repetitions of a sentence are counted.
 * Returns what takes it away.
 */
export function toast(text, { level = "ok", action = null, topic = "" } = {}) {
  if (!place) return () => {};
  const key = topic || `${level} ${text}`;
  const one = shown.get(key) ?? make(key);
  one.count += topic ? 0 : 1;
  set(one.element, { "data-level": level });
  setText(one.text, one.count > 1 ? `${text} (${one.count})` : text);
  one.button.hidden = !action;
  setText(one.button, action?.label ?? "");
  one.run = action?.run;
  clearTimeout(one.timer);
  one.timer = setTimeout(one.remove, SHOWN_MS[level]);
  while (shown.size > MAX_SHOWN) shown.values().next().value.remove();
  return one.remove;
}

function make(key) {
  const one = { count: 0, timer: 0, run: null };
  const act = () => {
    one.remove();
    one.run();
  };
  one.text = el("span");
  one.button = el("button", { type: "button", class: "wv-link", onclick: act });
  one.remove = () => {
    clearTimeout(one.timer);
    if (shown.get(key) === one) shown.delete(key);
    one.element.remove();
  };
  const close = { type: "button", class: "wv-icon", "aria-label": "Dismiss", onclick: one.remove };
  one.element = el(
    "div",
    { class: "wv-toast" },
    one.text,
    one.button,
    el("button", close, icon("close")),
  );
  shown.set(key, one);
  place.append(one.element);
  return one;
}
