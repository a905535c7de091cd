// Performance of the page: frames per second and round trip to the server; a click shows details.

import * as channel from "../channel.js";
import { el, set, setChildren, setText } from "../dom.js";
import { points } from "../scene/capacity.js";
import { isSoftware, renderer } from "../scene/graphics.js";
import { watch } from "../stores.js";
import * as viser from "../viser_page.js";

const EVERY_MS = 1000;
const PING_TICKS = 2;
const IDLE_FPS = 1; // viser's page draws a frame a second by itself

const HINT = "Frames drawn in a second, and the time to the server and back";

export function build() {
  let frames = 0;
  let rate = 0;
  /** @type {number | null} */
  let trip = null;
  /** @type {number | null} */
  let shownTrip = null;
  let watchers = 0;
  let ticks = 0;
  let sent = 0;
  const label = el("span");
  const more = el("dl", { class: "wv-card wv-rates-more", hidden: true });
  const button = el(
    "button",
    {
      type: "button",
      class: "wv-card wv-rates",
      "aria-expanded": "false",
      "data-tip": HINT,
      onclick: toggle,
    },
    label,
  );

  channel.on("Pong", () => {
    trip = performance.now() - sent;
    show();
  });
  watch("watchers", (values) => {
    watchers = values.get("count") ?? 0;
    show();
  });
  viser.beforeRender(() => (frames += 1));
  setInterval(tick, EVERY_MS);

  function tick() {
    rate = frames > IDLE_FPS ? frames : 0;
    frames = 0;
    ticks += 1;
    if (document.hidden) return;
    if (ticks % PING_TICKS === 0 && channel.isOpen()) {
      sent = performance.now();
      channel.send({ type: "Ping" });
    }
    show();
  }

  function show() {
    // While nothing is drawn nothing is late, and the page stands still.
    if (rate || shownTrip === null) shownTrip = trip;
    const parts = [`${rate} fps`, shownTrip === null ? "" : `${Math.round(shownTrip)} ms`];
    if (watchers > 1) parts.push(`${watchers} watching`);
    setText(label, parts.filter(Boolean).join(" · "));
    if (!more.hidden) explain();
  }

  function explain() {
    const { render } = viser.gl().info;
    const rows = [
      ["Frames drawn", `${rate} a second; none while nothing changes`],
      ["Server and back", trip === null ? "not measured yet" : `${trip.toFixed(1)} ms`],
      ["Watching", `${watchers} ${watchers === 1 ? "browser" : "browsers"}`],
      [
        "Drawn at once",
        `${render.triangles} triangles, ${render.points} points, ` + `${render.calls} calls`,
      ],
      ["Points held", `${points()} at once, to draw 20 frames a second`],
      ["Drawn by", drawnBy()],
    ];
    setChildren(
      more,
      rows.flatMap(([name, value], index) => {
        const [term, meaning] = [
          more.children[2 * index] ?? el("dt"),
          more.children[2 * index + 1] ?? el("dd"),
        ];
        setText(term, name);
        setText(meaning, value);
        return [term, meaning];
      }),
    );
  }

  function toggle() {
    more.hidden = !more.hidden;
    set(button, { "aria-expanded": String(!more.hidden), "data-tip": more.hidden ? HINT : null });
    if (!more.hidden) explain();
  }

  return el("div", { class: "wv-rates-box" }, button, more);
}

const drawnBy = () =>
  isSoftware() ? "the processor, slowly: this browser has no graphics acceleration" : renderer();
