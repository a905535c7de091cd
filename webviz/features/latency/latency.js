// "Stamp to screen": for each display, where the time from a stamp to the browsers goes.

import { disclosure } from "webviz/controls/disclosure.js";
import { el } from "webviz/dom.js";
import { findingsSection } from "webviz/panels/findings_sections.js";
import { signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";

/** @import {BrowserLatency, Latency, Stage} from "webviz/contents.js" */

/** @type {Record<string, string>} */
const NAMES = {
  received: "received",
  ready: "transform",
  decoded: "decoded",
  drawn: "drawn",
  sent: "sent",
  acknowledged: "acknowledged",
  painted: "painted",
};
const NOTHING = "No display has drawn a message since this was opened.";

export const install = () => findingsSection(stampToScreen);

/** The section; nothing is measured while it is folded. */
function stampToScreen() {
  const isOpen = signal(false);
  const latencies = store("latency");
  const list = () => {
    if (!isOpen.value) return null;
    const all = latencies.get("all") ?? [];
    return all.length ? all.map(waterfall) : [el("span", {}, NOTHING)];
  };
  const content = () => el("div", { class: "wv-latencies", role: "status" }, list);
  const element = disclosure("Stamp to screen", content, { class: "wv-latency" }, isOpen);
  return { element };
}

/** @param {Latency} latency */
function waterfall({ name, stages, p50, p99, waits_for: waitsFor, core, browsers }) {
  const serverEnd = end(stages);
  const whole = Math.max(serverEnd, ...browsers.map((to) => serverEnd + end(to.stages)), 1e-6);
  return el(
    "section",
    { class: "wv-waterfall", "aria-label": name },
    el(
      "header",
      {},
      el("b", { class: "wv-ellipsis" }, name),
      el("span", { class: "wv-quiet wv-number" }, `${ms(p50)}, p99 ${ms(p99)}`),
    ),
    ...stages.map((stage) => row(stage, 0, whole)),
    ...browsers.flatMap((to) => browser(to, serverEnd, whole)),
    el(
      "p",
      { class: "wv-quiet" },
      [waitsFor, `Takes ${percent(core)} of a core${browsers.map(link).join("")}.`]
        .join(" ")
        .trim(),
    ),
  );
}

/**
 * Return when the last of some stages ends.
 *
 * @param {readonly Stage[]} stages
 */
const end = (stages) => Math.max(0, ...stages.map(({ begin, p50 }) => begin + Math.max(p50, 0)));

/**
 * The rows of the way to a browser.
 *
 * @param {BrowserLatency} to
 * @param {number} start when that begins, in seconds
 * @param {number} whole
 */
function browser({ name, stages, p50, p99 }, start, whole) {
  if (!stages.length) return [];
  return [
    el(
      "div",
      { class: "wv-waterfall-browser wv-quiet" },
      el("span", { class: "wv-ellipsis" }, `To ${name}`),
      el("span", { class: "wv-number" }, `${ms(p50)}, p99 ${ms(p99)}`),
    ),
    ...stages.map((stage) => row(stage, start, whole)),
  ];
}

/**
 * @param {Stage} stage
 * @param {number} from when the first of its stages begins
 * @param {number} whole
 */
function row({ name, begin, p50, p99 }, from, whole) {
  const [left, width] = [Math.max(from + begin, 0) / whole, Math.max(p50, 0) / whole];
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

/** @param {BrowserLatency} to */
const link = ({ name, bytes_per_s: rate }) => `, ${perSecond(rate)} to ${name}`;

/** @param {number} seconds */
function ms(seconds) {
  const value = seconds * 1000;
  return Math.abs(value) < 9.95 ? `${value.toFixed(1)} ms` : `${value.toFixed(0)} ms`;
}

/** @param {number} share */
const percent = (share) => `${(share * 100).toFixed(1)} %`;

/** @param {number} bytes */
function perSecond(bytes) {
  if (bytes < 1000) return `${Math.round(bytes)} B/s`;
  return bytes < 1e6 ? `${(bytes / 1e3).toFixed(1)} kB/s` : `${(bytes / 1e6).toFixed(1)} MB/s`;
}
