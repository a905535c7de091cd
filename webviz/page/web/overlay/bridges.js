// The bridges over which live topics come, and which of them are not live.

import { el, set, setChildren, setText } from "../dom.js";
import { sanitized } from "../sanitize.js";
import { watch } from "../stores.js";

const MANY = 3;

export function build() {
  const list = el("output", { class: "wv-bridges", hidden: true });
  watch("bridges", (values) => {
    const all = values.get("all") ?? [];
    list.hidden = all.length === 0;
    setChildren(list, cards(all));
  });
  return list;
}

/**
 * Those of many that are live share one line.
 *
 * @param {[string, string][]} all
 */
function cards(all) {
  if (all.length <= MANY) return all.map(card);
  const down = all.filter(([, problem]) => problem);
  return [card([`${all.length - down.length} robots connected`, ""]), ...down.map(card)];
}

/** @param {[string, string]} bridge */
function card([name, problem]) {
  const element = el("div", { class: "wv-card wv-bridge" });
  setText(element, problem ? `${sanitized(name)} · not live` : sanitized(name));
  set(element, {
    "data-state": problem ? "down" : "up",
    "data-tip": problem ? sanitized(problem) : "Connected over a bridge",
  });
  return element;
}
