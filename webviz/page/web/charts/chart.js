// A chart of a plug-in's panel: curves over time, with a legend that reads them out.
//
// All pages have the same values; each pauses, zooms and pans for itself.

import { needs } from "../access.js";
import { el, set, setText } from "../dom.js";
import { icon, iconButton } from "../icons.js";
import { newest } from "../newest.js";
import { download } from "../download.js";
import { timeOfDay } from "../time_text.js";
import { byAxis, csv, curvesOf, extent } from "./curves.js";
import { draw, inside } from "./draw.js";
import { listenToGestures } from "./gestures.js";
import { hover, onHover } from "./hover.js";
import { colorOf, makeLegend } from "./legend.js";
import { at, roomy } from "./scale.js";

/** @import {Curve, Facts, Piece, Range, ValuesOf} from "../types.js" */
/** @import {Zoom} from "./zoom.js" */

/**
 * @typedef {{window: number, now: number, across: number, seeks: boolean, curves: Facts[]}} ChartFacts
 *   `across` is the key of the curve that stands in place of time, -1 for none
 */

/** @param {HTMLElement} button */
const isPressed = (button) => button.getAttribute("aria-pressed") === "true";

/**
 * @param {string} name of its icon
 * @param {string} label
 * @param {() => void} pressed
 */
function toggle(name, label, pressed) {
  const button = iconButton(name, label, () => {
    set(button, { "aria-pressed": String(!isPressed(button)) });
    pressed();
  });
  return button;
}

/**
 * See `plugin_widgets.js`; `send(name)` removes a curve, `send(String(time))` goes to a time.
 *
 * @param {unknown} _
 * @param {(value: string) => unknown} send
 */
export function chart(_, send) {
  /** @type {WeakMap<object, Piece>} */
  const known = new WeakMap();
  /** @type {Curve[]} */
  let live = []; // the curves as they are
  /** @type {{curves: Curve[], end: number} | null} */
  let held = null; // and as they were when this page paused
  /** @type {ChartFacts} */
  let facts = { window: 1, now: 0, across: -1, seeks: false, curves: [] };
  /** @type {Zoom | null} */
  let zoom = null;
  /** @type {number | null} */
  let cursor = null;
  let frame = 0;

  const canvas = el("canvas", {
    class: "wv-chart-canvas",
    role: "img",
    tabindex: 0,
    "aria-label": "Chart",
  });
  const box = listenToGestures(canvas, {
    area,
    shown,
    zoom: () => zoom,
    setZoom,
    point,
    pause: togglePause,
  });
  const pause = iconButton("pause", "Pause", togglePause);
  const back = iconButton("reset", "Reset zoom (double click)", () => setZoom(null));
  const save = iconButton("download", "Download as CSV", () => download("plot.csv", csv(curves())));
  const sums = toggle("list", "Statistics of the visible values", later);
  const follow = needs(
    "UseWidget",
    toggle("clock", "Move the time with the pointer", () => {}),
  );
  follow.hidden = true;
  const when = el("span", { class: "wv-quiet wv-number" });
  const legend = makeLegend(send);
  const element = el(
    "div",
    { class: "wv-chart" },
    el("div", { class: "wv-chart-tools" }, pause, back, save, sums, follow, when),
    el("div", { class: "wv-chart-place" }, canvas, box),
    legend.element,
  );
  const observer = new ResizeObserver(later);
  observer.observe(canvas);
  const seek = newest((time) => send(String(time)));
  const unshare = onHover((time) => {
    cursor = time;
    later();
  });

  const curves = () => held?.curves ?? live;
  const axes = () => byAxis(curves(), facts.across);
  /** @param {Curve[]} some */
  const fitting = (some) => roomy(...extent(some, times()));

  /** @returns {Range} */
  function times() {
    const end = held?.end ?? facts.now;
    return zoom?.times ?? [end - facts.window, end];
  }

  function shown() {
    return { times: times(), values: zoom?.values ?? fitting(axes().left) };
  }

  function area() {
    return inside(canvas.clientWidth, canvas.clientHeight, axes().rights.length);
  }

  function later() {
    frame ||= requestAnimationFrame(() => {
      frame = 0;
      if (!element.isConnected) return;
      const { across, rights } = axes();
      draw(canvas, {
        ...{ curves: curves(), colors: colorOf, ...shown(), cursor },
        rights: rights.map((some) => ({
          ...{ axis: some[0].axis, range: fitting(some) },
          color: some.length === 1 ? colorOf(some[0].key) : "",
        })),
        across: across && { curve: across, range: fitting([across]) },
      });
      setText(when, cursor === null ? "" : timeOfDay(cursor, true).replace(/^.* /, ""));
      legend.read(curves(), cursor ?? Infinity, isPressed(sums) ? times() : null);
    });
  }

  function togglePause() {
    held = held ? null : { curves: live, end: facts.now };
    mark();
  }

  /** @param {Zoom | null} next */
  function setZoom(next) {
    zoom = next;
    mark();
  }

  function mark() {
    const label = held ? "Resume" : "Pause";
    set(pause, { "aria-pressed": String(held !== null), "aria-label": label, "data-tip": label });
    pause.replaceChildren(icon(held ? "play" : "pause"));
    set(back, { disabled: !zoom });
    later();
  }

  /** @param {number | null} share */
  function point(share) {
    const time = share === null || axes().across ? null : at(share, times());
    if (time === cursor) return;
    hover(time);
    if (isPressed(follow) && time !== null) seek.to(time);
  }

  /**
   * @param {ChartFacts} next
   * @param {ValuesOf<"panel">} store
   * @param {string} id
   */
  function update(next, store, id) {
    facts = next;
    live = curvesOf(facts.curves, store, id, known);
    if (held)
      held.curves = held.curves.filter(({ key }) => live.some((curve) => curve.key === key));
    follow.hidden = !facts.seeks || facts.across >= 0;
    legend.show(live);
    set(element, { "data-empty": live.length ? null : "" });
    later();
  }

  function close() {
    observer.disconnect();
    unshare();
  }

  mark();
  return { element, update, close };
}
