// Short messages over the scene, which go by themselves.

import { el } from "../dom.js";

const SHOWN_MS = { ok: 5000, warn: 10000, error: 10000 };
const MAX_SHOWN = 4;

let place = null;

export function install(scene) {
  place = el("div", { class: "wv-toasts", role: "status", "aria-live": "polite" });
  scene.append(place);
}

/**
 * Shows a sentence with a level, "ok", "warn" or "error", and perhaps an action: `{label, run}`.
 * Returns what takes it away.
 */
export function toast(text, { level = "ok", action = null } = {}) {
  if (!place) return () => {};
  const remove = () => shown.remove();
  const run = () => {
    remove();
    action.run();
  };
  const shown = el(
    "div",
    { class: "wv-toast", "data-level": level, onclick: remove },
    text,
    action && el("button", { type: "button", class: "wv-link", onclick: run }, action.label),
  );
  place.append(shown);
  while (place.children.length > MAX_SHOWN) place.firstElementChild.remove();
  setTimeout(remove, SHOWN_MS[level]);
  return remove;
}
