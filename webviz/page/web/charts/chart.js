// A chart of a plug-in's panel: curves over time, with a legend that reads them out.
//
// All pages have the same values; each pauses, zooms and pans for itself.
//
// uPlot 1.6.32 was tried in place of this folder, with 10 curves of 600 000 values in a browser that
// draws in software. A tenth of them panned at 25 frames per second, here at 33 at best and 9 on a busy
// machine; 30 s of them at 57, here at 41 to 60: too close to decide. But all its series share one
// array of times, so curves with stamps of their own are joined into rows that are mostly empty, and
// each new piece means new arrays; and gestures, legend, statistics, CSV and a curve in place of time
// would stay ours, beside 51 kB of it.

import { needs } from "webviz/access.js";
import { el } from "webviz/dom.js";
import { icon, iconButton } from "webviz/icons.js";
import { newest } from "webviz/newest.js";
import { batch, computed, effect, root, signal, untracked } from "webviz/signals.js";
import { download } from "webviz/download.js";
import { timeOfDay } from "webviz/time_text.js";
import { byAxis, csv, curvesOf, extent } from "webviz/charts/curves.js";
import { draw, inside } from "webviz/charts/draw.js";
import { listenToGestures } from "webviz/charts/gestures.js";
import { hover, onHover } from "webviz/charts/hover.js";
import { colorOf, makeLegend } from "webviz/charts/legend.js";
import { at, roomy } from "webviz/charts/scale.js";

/** @import {Curve, Facts, Piece, Range, ValuesOf} from "webviz/types.js" */
/** @import {Zoom} from "webviz/charts/zoom.js" */

/**
 * @typedef {{window: number, now: number, across: number, seeks: boolean, curves: Facts[]}} ChartFacts
 *   `across` is the key of the curve that stands in place of time, -1 for none
 * @typedef {ReturnType<typeof makeView>} View
 */

/** The curves of a chart as they are or were when this page paused, and the part that is in sight. */
function makeView() {
  const live = signal(/** @type {Curve[]} */ ([]));
  const snapshot = signal(/** @type {{curves: Curve[], end: number} | null} */ (null));
  /** @type {ChartFacts} */
  const none = { window: 1, now: 0, across: -1, seeks: false, curves: [] };
  const facts = signal(none);
  const zoom = signal(/** @type {Zoom | null} */ (null));
  const cursor = signal(/** @type {number | null} */ (null));
  const curves = () => snapshot.value?.curves ?? live.value;
  const axes = computed(() => byAxis(curves(), facts.value.across));
  const times = computed(() => {
    const end = snapshot.value?.end ?? facts.value.now;
    return /** @type {Range} */ (zoom.value?.times ?? [end - facts.value.window, end]);
  });
  /** @param {Curve[]} some */
  const fitting = (some) => roomy(...extent(some, times.value));
  const ranges = () => ({
    times: times.value,
    values: zoom.value?.values ?? fitting(axes.value.left),
  });
  const hasSums = signal(false);
  const isFollowing = signal(false);
  const seeks = () => facts.value.seeks && facts.value.across < 0;
  return {
    ...{ live, snapshot, facts, zoom, cursor, curves, axes, times },
    ...{ fitting, ranges, hasSums, isFollowing, seeks },
    togglePause() {
      snapshot.value = snapshot.value ? null : { curves: live.value, end: facts.value.now };
    },
  };
}

/**
 * See `plugin_widgets.js`; `send(name)` removes a curve, `send(String(time))` goes to a time.
 *
 * @param {unknown} _
 * @param {(value: string) => unknown} send
 */
export const chart = (_, send) =>
  root((end) => {
    const view = makeView();
    const canvas = el("canvas", {
      class: "wv-chart-canvas",
      role: "img",
      tabindex: 0,
      "aria-label": "Chart",
    });
    const legend = makeLegend(send);
    const place = el("div", { class: "wv-chart-place" }, canvas, gestures(canvas, view, send));
    const element = el(
      "div",
      { class: "wv-chart", "data-empty": () => (view.live.value.length ? null : "") },
      place,
      legend.element,
    );
    const redraw = drawing(element, canvas, view, legend);
    const observer = new ResizeObserver(redraw);
    observer.observe(canvas);
    const unshare = onHover((time) => (view.cursor.value = time));
    /** @type {WeakMap<object, Piece>} */
    const cache = new WeakMap();
    return {
      element,
      head: tools(view),
      /**
       * @param {ChartFacts} next
       * @param {ValuesOf<"panel">} store
       * @param {string} id
       */
      update(next, store, id) {
        const curves = curvesOf(next.curves, store, id, cache);
        batch(() => {
          view.facts.value = next;
          view.live.value = curves;
          const { snapshot } = view;
          /** @param {Curve} curve */
          const isThere = ({ key }) => curves.some((curve) => curve.key === key);
          if (snapshot.value)
            snapshot.value = { ...snapshot.value, curves: snapshot.value.curves.filter(isThere) };
        });
        legend.show(curves);
      },
      close() {
        observer.disconnect();
        unshare();
        end();
      },
    };
  });

/**
 * @param {HTMLCanvasElement} canvas
 * @param {View} view
 * @param {(value: string) => unknown} send
 */
function gestures(canvas, view, send) {
  const seek = newest((time) => send(String(time)));
  /** @param {number | null} share */
  function point(share) {
    const time = share === null || view.axes.value.across ? null : at(share, view.times.value);
    if (time === view.cursor.value) return;
    hover(time);
    if (view.isFollowing.value && time !== null) seek.to(time);
  }
  return listenToGestures(canvas, {
    area: () => inside(canvas.clientWidth, canvas.clientHeight, view.axes.value.rights.length),
    ranges: view.ranges,
    zoom: () => view.zoom.value,
    setZoom: (zoom) => (view.zoom.value = zoom),
    point,
    pause: view.togglePause,
  });
}

/**
 * The buttons of a chart.
 *
 * @param {View} view
 */
function tools(view) {
  const pauseLabel = () => (view.snapshot.value ? "Resume" : "Pause");
  const pause = el(
    "button",
    {
      type: "button",
      class: "wv-icon",
      onclick: view.togglePause,
      "aria-pressed": () => String(view.snapshot.value !== null),
      "aria-label": pauseLabel,
      "data-tip": pauseLabel,
    },
    () => icon(view.snapshot.value ? "play" : "pause"),
  );
  const reset = iconButton("reset", "Reset zoom (double click)", () => (view.zoom.value = null), {
    disabled: () => !view.zoom.value,
  });
  const save = iconButton("download", "Download as CSV", () =>
    download("plot.csv", csv(view.curves())),
  );
  const { hasSums, isFollowing } = view;
  const sums = iconButton(
    "list",
    "Statistics of the visible values",
    () => (hasSums.value = !hasSums.value),
    { "aria-pressed": () => String(hasSums.value) },
  );
  const follow = iconButton(
    "clock",
    "Move the time with the pointer",
    () => (isFollowing.value = !isFollowing.value),
    { "aria-pressed": () => String(isFollowing.value), hidden: () => !view.seeks() },
  );
  const when = () =>
    view.cursor.value === null ? "" : timeOfDay(view.cursor.value, true).replace(/^.* /, "");
  const isEmpty = () => !view.live.value.length;
  return el(
    "span",
    { class: "wv-panel-tools wv-chart-tools", hidden: isEmpty },
    el("span", { class: "wv-quiet wv-number" }, when),
    ...[pause, reset, sums, needs("UseWidget", follow), save],
  );
}

/**
 * Draws in the next frame whatever has changed; returns what draws because of something else.
 *
 * @param {HTMLElement} element
 * @param {HTMLCanvasElement} canvas
 * @param {View} view
 * @param {ReturnType<typeof makeLegend>} legend
 */
function drawing(element, canvas, view, legend) {
  let frame = 0;
  function now() {
    frame = 0;
    if (!element.isConnected) return;
    const { across, rights } = view.axes.value;
    const cursor = view.cursor.value;
    draw(canvas, {
      ...{ curves: view.curves(), colors: colorOf, ...view.ranges(), cursor },
      rights: rights.map((some) => ({
        ...{ axis: some[0].axis, range: view.fitting(some) },
        color: some.length === 1 ? colorOf(some[0].key) : "",
      })),
      across: across && { curve: across, range: view.fitting([across]) },
    });
    legend.read(view.curves(), cursor ?? Infinity, view.hasSums.value ? view.times.value : null);
  }
  const later = () => {
    frame ||= requestAnimationFrame(() => untracked(now));
  };
  effect(() => {
    for (const part of [view.live, view.snapshot, view.facts, view.zoom, view.cursor, view.hasSums])
      void part.value;
    later();
  });
  return later;
}
