// Performance of the page: frames per second and round trip to the server; a click shows details.

import * as channel from "webviz/channel.js";
import { el } from "webviz/dom.js";
import { points } from "webviz/scene/capacity.js";
import { isSoftware, renderer } from "webviz/scene/graphics.js";
import { batch, each, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import * as viser from "webviz/viser_page.js";

const EVERY_MS = 1000;
const PING_TICKS = 2;
const IDLE_FPS = 1; // viser's page draws a frame a second anyway

const HINT = "Frames drawn per second, and the round trip to the server";

const watchers = () => store("watchers").get("count") ?? 0;

export function build() {
  const { rate, trip, shownTrip, now } = measurements();
  const isOpen = signal(false);
  const text = () => [
    `${rate.value} fps`,
    shownTrip.value === null ? "" : `${Math.round(shownTrip.value)} ms`,
    watchers() > 1 ? `${watchers()} watching` : "",
  ];
  const rows = each(
    // What the renderer counts changes without notice.
    () => (isOpen.value && now.value >= 0 ? facts(rate.value, trip.value) : []),
    ([name]) => name,
    (row, name) => [el("dt", {}, name), el("dd", {}, () => row.value[1])],
  );
  return el(
    "div",
    { class: "wv-rates-box" },
    el(
      "button",
      {
        type: "button",
        class: "wv-card wv-rates",
        "aria-expanded": () => String(isOpen.value),
        "data-tip": () => (isOpen.value ? null : HINT),
        onclick: () => (isOpen.value = !isOpen.value),
      },
      el("span", {}, () => text().filter(Boolean).join(" · ")),
    ),
    el("dl", { class: "wv-card wv-rates-more", hidden: () => !isOpen.value }, () => rows().flat()),
  );
}

/**
 * Signals: frames in the last second, the last round trip to the server, and the one that is shown,
 * in milliseconds; `now` changes each second.
 */
function measurements() {
  const rate = signal(0);
  const now = signal(0);
  const trip = signal(/** @type {number | null} */ (null));
  const shownTrip = signal(/** @type {number | null} */ (null));
  let frames = 0;
  let ticks = 0;
  let sendTime = 0;
  // While nothing is drawn nothing is late, and the page stands still.
  const show = () => {
    if (rate.value || shownTrip.value === null) shownTrip.value = trip.value;
  };
  const tick = () =>
    batch(() => {
      const fps = frames > IDLE_FPS ? frames : 0;
      frames = 0;
      ticks += 1;
      if (document.hidden) return;
      rate.value = fps;
      now.value = ticks;
      if (ticks % PING_TICKS === 0 && channel.isOpen()) {
        sendTime = performance.now();
        channel.send({ type: "Ping" });
      }
      show();
    });
  channel.on("Pong", () =>
    batch(() => {
      trip.value = performance.now() - sendTime;
      show();
    }),
  );
  viser.beforeRender(() => (frames += 1));
  setInterval(tick, EVERY_MS);
  return { rate, trip, shownTrip, now };
}

/**
 * @param {number} rate
 * @param {number | null} trip
 * @returns {[string, string][]}
 */
function facts(rate, trip) {
  const { render } = viser.gl().info;
  const watching = watchers();
  return [
    ["Frames drawn", `${rate} a second; none while nothing changes`],
    ["Round trip", trip === null ? "not measured yet" : `${trip.toFixed(1)} ms`],
    ["Watching", `${watching} ${watching === 1 ? "browser" : "browsers"}`],
    [
      "Drawn at once",
      `${render.triangles} triangles, ${render.points} points, ${render.calls} calls`,
    ],
    ["Points held", `${points()} at once, to draw 20 frames a second`],
    ["Drawn by", drawnBy()],
  ];
}

const drawnBy = () =>
  isSoftware() ? "the processor, slowly: this browser has no graphics acceleration" : renderer();
