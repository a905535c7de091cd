// Reports to the server how this page draws, and when it has painted what came before a probe. Those of
// watchers would show up in the findings of others, so they are not sent.

import { why } from "webviz/access.js";
import * as channel from "webviz/channel.js";
import { isSoftware, renderer, whenDrawn } from "webviz/scene/graphics.js";
import * as viser from "webviz/viser_page.js";

const TICK_MS = 1000;
const REPORT_TICKS = 5;
const FRAME_EVERY_MS = 400; // of frames that are measured
const MAX_NAME = 200;
const MAX_S = 86_400;

/** @type {{number: number, began: number}[]} */
const probes = [];

/**
 * Sends a `HasPainted` once the frame with everything before this call is on the screen.
 *
 * @param {number} number
 */
export function probe(number) {
  if (why("HasPainted")) return;
  probes.push({ number, began: performance.now() });
  viser.requestRender();
}

export function install() {
  /** @type {number[]} */
  let frames = [];
  let began = 0;
  let measured = -FRAME_EVERY_MS;
  let expected = performance.now() + TICK_MS;
  let late = 0;
  let ticks = 0;

  viser.beforeRender(() => (began = performance.now()));
  viser.afterRender(() => {
    const isDue = began - measured >= FRAME_EVERY_MS;
    if (!probes.length && !isDue) return;
    const painted = probes.splice(0);
    const from = (measured = began);
    whenDrawn((isDrawn) => {
      if (!isDrawn) return;
      const now = performance.now();
      if (isDue && !document.hidden) frames.push(now - from);
      for (const each of painted) {
        const waited = Math.min((now - each.began) / 1000, MAX_S);
        channel.send({ type: "HasPainted", probe: each.number, waited_s: waited });
      }
    });
  });

  function tick() {
    const now = performance.now();
    late = Math.max(late, now - expected);
    expected = now + TICK_MS;
    ticks += 1;
    if (ticks % REPORT_TICKS === 0) report();
  }

  function report() {
    if (!channel.isOpen() || why("Vitals")) return;
    frames.sort((a, b) => a - b);
    channel.send({
      type: "Vitals",
      renderer: renderer().slice(0, MAX_NAME),
      is_software: isSoftware(),
      is_hidden: document.hidden,
      frame_s: Math.min((frames[frames.length >> 1] ?? 0) / 1000, MAX_S),
      late_s: Math.min(Math.max(late, 0) / 1000, MAX_S),
    });
    frames = [];
    late = 0;
  }

  setInterval(tick, TICK_MS);
  document.addEventListener("visibilitychange", report);
  channel.onOpen(() => setTimeout(report));
}
