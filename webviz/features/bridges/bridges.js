// The bridges over which live topics come, and which of them are not live.

import { el, set, setChildren, setText } from "webviz/dom.js";
import { sanitized } from "webviz/sanitize.js";
import { overlay } from "webviz/overlay/overlay.js";
import { watch } from "webviz/stores.js";

const MANY = 3;

export function install() {
  const list = el("output", { class: "wv-bridges", hidden: true });
  watch("bridges", (values) => {
    const all = values.get("all") ?? [];
    list.hidden = all.length === 0;
    setChildren(list, cards(all));
  });
  overlay("status", "bridges", list);
}

/**
 * Those of many that are live share one line.
 *
 * @param {[string, string, string][]} all
 */
function cards(all) {
  if (all.length <= MANY) return all.map(card);
  const down = all.filter(([, problem]) => problem);
  const strained = all.filter(([, problem, remark]) => remark && !problem);
  const summary = card([`${all.length - down.length} robots connected`, "", ""]);
  return [summary, ...[...down, ...strained].map(card)];
}

/** @param {[string, string, string]} bridge */
function card([name, problem, remark]) {
  const element = el("div", { class: "wv-card wv-bridge" });
  const state = problem ? "not live" : sanitized(remark);
  setText(element, state ? `${sanitized(name)} · ${state}` : sanitized(name));
  set(element, {
    "data-state": problem ? "down" : remark ? "strained" : "up",
    "data-tip": problem ? sanitized(problem) : "Live topics come from here",
  });
  return element;
}
