// "Stamp to screen": for each display, where the time from a stamp to the browsers goes.

import { el } from "../dom.js";
import { watch } from "../stores.js";

/** @import {ShownLatency, ShownStage} from "../contents.js" */

/** @type {Record<string, string>} */
const NAMES = {
  received: "received",
  ready: "transform",
  decoded: "decoded",
  drawn: "drawn",
  sent: "sent",
};
const NOTHING = "No display has drawn a message since this was opened.";

/** The section; nothing is measured while it is folded. */
export function stampToScreen() {
  const list = el("div", { class: "wv-latencies", role: "status" }, NOTHING);
  const section = el(
    "details",
    { class: "wv-latency" },
    el("summary", {}, "Stamp to screen"),
    list,
  );
  let end = () => {};
  section.addEventListener("toggle", () => {
    end();
    end = section.open ? watch("latency", show) : () => {};
  });

  /** @param {{get(key: "all"): ShownLatency[] | undefined}} values */
  function show(values) {
    const all = values.get("all") ?? [];
    list.replaceChildren(...(all.length ? all.map(waterfall) : [NOTHING]));
  }

  return { element: section, close: () => end() };
}

/** @param {ShownLatency} latency */
function waterfall({ name, stages, p50, p99, waits_for: waitsFor, core }) {
  const whole = Math.max(...stages.map(({ begin, p50: own }) => begin + Math.max(own, 0)), 1e-6);
  return el(
    "section",
    { class: "wv-waterfall", "aria-label": name },
    el(
      "header",
      {},
      el("b", { class: "wv-ellipsis" }, name),
      el("span", { class: "wv-quiet wv-number" }, `${ms(p50)}, p99 ${ms(p99)}`),
    ),
    ...stages.map((stage) => row(stage, whole)),
    el(
      "p",
      { class: "wv-quiet" },
      [waitsFor, `Takes ${percent(core)} of a core.`].join(" ").trim(),
    ),
  );
}

/**
 * @param {ShownStage} stage
 * @param {number} whole
 */
function row({ name, begin, p50, p99 }, whole) {
  const [left, width] = [Math.max(begin, 0) / whole, Math.max(p50, 0) / whole];
  const bar = el("span", { class: "wv-waterfall-bar", "data-stage": name });
  bar.style.left = `${100 * left}%`;
  bar.style.width = `${100 * width}%`;
  return el(
    "div",
    {
      class: "wv-waterfall-row",
      "data-tip": `${NAMES[name] ?? name}: p50 ${ms(p50)}, p99 ${ms(p99)}`,
    },
    el("span", { class: "wv-quiet" }, NAMES[name] ?? name),
    el("span", { class: "wv-waterfall-track" }, bar),
    el("span", { class: "wv-number" }, ms(p50)),
  );
}

/** @param {number} seconds */
function ms(seconds) {
  const value = seconds * 1000;
  return Math.abs(value) < 9.95 ? `${value.toFixed(1)} ms` : `${value.toFixed(0)} ms`;
}

/** @param {number} share */
const percent = (share) => `${(share * 100).toFixed(1)} %`;
