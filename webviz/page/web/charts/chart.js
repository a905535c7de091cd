// A chart of a plug-in's panel: curves over time, with a legend that reads them out.
//
// All pages have the same values; each pauses, zooms and pans for itself.

import { needs } from "../access.js";
import { el, set, setChildren, setText } from "../dom.js";
import { icon, iconButton } from "../icons.js";
import { download } from "../shell/download.js";
import { timeOfDay } from "../shell/time_text.js";
import { csv, curvesOf, extent, statistics, valueAt } from "./curves.js";
import { draw, inside } from "./draw.js";
import { hover, onHover, seeking } from "./hover.js";
import { at, changed, numberText, roomy, withUnit } from "./scale.js";

/** @import {Curve, Facts, Piece, Range, ValuesOf, Vec2} from "../types.js" */

/**
 * @typedef {{window: number, now: number, across: number, seeks: boolean, curves: Facts[]}} ChartFacts
 *   `across` is the key of the curve that stands in place of time, -1 for none
 */

const WHEEL = 1.2;
const HUES = [210, 28, 140, 0, 270, 180, 60, 320, 100, 240, 15, 160];
/** @type {Record<string, {move?: number, by?: number}>} */
const KEYS = {
  ArrowLeft: { move: -0.1 },
  ArrowRight: { move: 0.1 },
  "+": { by: 1 / WHEEL },
  "-": { by: WHEEL },
};

/** @param {number} key */
const color = (key) => `hsl(${HUES[key % HUES.length]} 75% 55%)`;

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
  /** @type {Curve[] | null} */
  let held = null; // and as they were when this page paused
  /** @type {ChartFacts} */
  let facts = { window: 1, now: 0, across: -1, seeks: false, curves: [] };
  let end = 0; // of the window, stands still while paused
  /** @type {{times: Range, values: Range | null} | null} */
  let zoomed = null; // {times, values}; values null for those that fit
  /** @type {number | null} */
  let cursor = null;
  /** @type {{from: Vec2, times: Range, values: Range, isBox: boolean, isFar: boolean} | null} */
  let drag = null;
  let frame = 0;
  let hasSums = false;
  let isFollowed = false;

  const canvas = el("canvas", {
    class: "wv-chart-canvas",
    role: "img",
    tabindex: 0,
    "aria-label": "Chart",
    onwheel: wheel,
    onpointerdown: press,
    onpointermove: move,
    onpointerup: release,
    onpointerleave: () => point(null),
    ondblclick: reset,
    onkeydown: key,
  });
  const box = el("div", { class: "wv-chart-box", hidden: true });
  const pause = iconButton("pause", "Pause", togglePause);
  const back = iconButton("reset", "Reset zoom (double click)", reset);
  const save = iconButton("download", "Download as CSV", () => download("plot.csv", csv(shown())));
  const sums = iconButton("list", "Statistics of the visible values", () => {
    hasSums = !hasSums;
    set(sums, { "aria-pressed": String(hasSums) });
    later();
  });
  const when = el("span", { class: "wv-quiet wv-number" });
  const legend = el("ul", { class: "wv-chart-legend" });
  /** @type {Map<number, {element: HTMLElement, value: HTMLElement, problem: HTMLElement, sums: HTMLElement}>} */
  const entries = new Map();
  const element = el(
    "div",
    { class: "wv-chart" },
    el("div", { class: "wv-chart-tools" }, pause, back, save, sums, when),
    el("div", { class: "wv-chart-place" }, canvas, box),
    legend,
  );
  const observer = new ResizeObserver(later);
  observer.observe(canvas);

  const go = seeking((time) => send(String(time)));
  const follow = needs(
    "UseWidget",
    iconButton("clock", "Move the time with the pointer", () => {
      isFollowed = !isFollowed;
      set(follow, { "aria-pressed": String(isFollowed) });
    }),
  );
  follow.hidden = true;
  sums.after(follow);
  const unshare = onHover((time) => {
    cursor = time;
    later();
  });

  const shown = () => held ?? live;
  const across = () => shown().find(({ key: one }) => one === facts.across) ?? null;
  /** @param {number} axis */
  const curvesAt = (axis) => shown().filter((each) => each.axis === axis && each !== across());
  const rightAxes = () =>
    [...new Set(shown().map(({ axis }) => axis))]
      .filter((axis) => axis > 0 && curvesAt(axis).length > 0)
      .toSorted((a, b) => a - b);
  const times = () => zoomed?.times ?? [end - facts.window, end];
  const values = () => zoomed?.values ?? roomy(...extent(curvesAt(0), times()));

  function later() {
    frame ||= requestAnimationFrame(() => {
      frame = 0;
      if (!element.isConnected) return;
      const over = across();
      draw(canvas, {
        ...{ curves: shown(), colors: color, times: times(), values: values(), cursor },
        rights: rightAxes().map((axis) => {
          const curves = curvesAt(axis);
          const range = roomy(...extent(curves, times()));
          return { axis, range, color: curves.length === 1 ? color(curves[0].key) : "" };
        }),
        across: over && { curve: over, range: roomy(...extent([over], times())) },
      });
      readOut();
    });
  }

  function togglePause() {
    held = held ? null : live;
    end = facts.now;
    mark();
  }

  function reset() {
    zoomed = null;
    mark();
  }

  function mark() {
    set(pause, { "aria-pressed": String(held !== null) });
    const label = held ? "Resume" : "Pause";
    set(pause, { "aria-label": label, "data-tip": label });
    pause.replaceChildren(icon(held ? "play" : "pause"));
    set(back, { disabled: !zoomed });
    later();
  }

  const area = () => inside(canvas.clientWidth, canvas.clientHeight, rightAxes().length);

  // Where in the area of the curves a pointer is, from 0 to 1 each, y upwards.
  /**
   * @param {MouseEvent} event
   * @returns {Vec2}
   */
  function shares({ clientX, clientY }) {
    const { left, top, width, height } = area();
    const from = canvas.getBoundingClientRect();
    return [(clientX - from.left - left) / width, 1 - (clientY - from.top - top) / height];
  }

  /**
   * @param {{around?: number, by?: number, move?: number}} change
   * @param {boolean} [isValues]
   */
  function zoom(change, isValues = false) {
    zoomed = isValues
      ? { times: times(), values: changed(values(), change) }
      : { times: changed(times(), change), values: zoomed?.values ?? null };
    const [from, to] = zoomed.times;
    if (!(to - from > 1e-6) || to - from > 1e6) zoomed = null;
    mark();
  }

  /** @param {WheelEvent} event */
  function wheel(event) {
    event.preventDefault();
    const [x, y] = shares(event);
    const isValues = event.shiftKey || x < 0;
    // Browsers turn the wheel sideways with Shift.
    const by = WHEEL ** Math.sign(event.deltaY || event.deltaX);
    zoom({ around: isValues ? y : x, by }, isValues);
  }

  /** @param {PointerEvent} event */
  function press(event) {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    drag = {
      from: shares(event),
      times: times(),
      values: values(),
      isBox: event.shiftKey,
      isFar: false,
    };
  }

  /**
   * @param {PointerEvent} event
   * @returns {void}
   */
  function move(event) {
    const place = shares(event);
    if (!drag) {
      const isInside = place[0] >= 0 && place[0] <= 1 && !across();
      return point(isInside ? at(place[0], times()) : null);
    }
    const [dx, dy] = [place[0] - drag.from[0], place[1] - drag.from[1]];
    const { width, height } = area();
    drag.isFar ||= Math.hypot(dx * width, dy * height) > 3;
    if (!drag.isFar) return;
    if (drag.isBox) return showBox(drag.from, place);
    const isUp = zoomed?.values || Math.abs(dy * height) > 20;
    zoomed = {
      times: changed(drag.times, { move: -dx }),
      values: isUp ? changed(drag.values, { move: -dy }) : null,
    };
    mark();
  }

  /** @param {PointerEvent} event */
  function release(event) {
    const [a, b] = [drag?.from, shares(event)];
    if (
      a &&
      drag?.isBox &&
      drag.isFar &&
      Math.abs(a[0] - b[0]) > 0.005 &&
      Math.abs(a[1] - b[1]) > 0.005
    ) {
      /**
       * @param {number} i
       * @param {Range} range
       * @returns {Range}
       */
      const part = (i, range) => [at(Math.min(a[i], b[i]), range), at(Math.max(a[i], b[i]), range)];
      zoomed = { times: part(0, drag.times), values: part(1, drag.values) };
    }
    drag = null;
    box.hidden = true;
    mark();
  }

  /**
   * @param {Vec2} a
   * @param {Vec2} b
   */
  function showBox(a, b) {
    const { left, top, width, height } = area();
    const [x, y] = [left + Math.min(a[0], b[0]) * width, top + (1 - Math.max(a[1], b[1])) * height];
    Object.assign(box.style, {
      left: `${x}px`,
      top: `${y}px`,
      width: `${Math.abs(a[0] - b[0]) * width}px`,
      height: `${Math.abs(a[1] - b[1]) * height}px`,
    });
    box.hidden = false;
  }

  /** @param {KeyboardEvent} event */
  function key(event) {
    if (KEYS[event.key]) zoom(KEYS[event.key]);
    else if (event.key === "Escape" && zoomed) reset();
    else if (event.key === " ") togglePause();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** @param {number | null} time */
  function point(time) {
    if (time === cursor) return;
    hover(time);
    if (isFollowed && time !== null) go(time);
  }

  function readOut() {
    const time = cursor ?? Infinity;
    setText(when, cursor === null ? "" : timeOfDay(cursor, true).replace(/^.* /, ""));
    for (const curve of shown()) {
      const found = valueAt(curve, time);
      const text = !found
        ? ""
        : Number.isNaN(found.value)
          ? "no value"
          : withUnit(numberText(found.value, 0.001), curve.unit);
      const shownEntry = entries.get(curve.key);
      if (!shownEntry) continue;
      setText(shownEntry.value, text);
      setText(shownEntry.sums, hasSums ? sumsOf(curve) : "");
    }
  }

  /** @param {Curve} curve */
  function sumsOf(curve) {
    const { count, low, high, mean } = statistics(curve, times());
    if (!count) return "No values in this span.";
    const [least, most, middle] = [low, high, mean].map((each) => numberText(each, 0.001));
    const sums = withUnit(`min ${least}, max ${most}, mean ${middle}`, curve.unit);
    return `${sums}, ${count} values`;
  }

  function showLegend() {
    for (const { key: id, name, problem } of live) {
      const known = entries.get(id) ?? entry(id, name);
      entries.set(id, known);
      setText(known.problem, problem);
    }
    for (const id of entries.keys())
      if (!live.some((curve) => curve.key === id)) entries.delete(id);
    setChildren(
      legend,
      live.flatMap((curve) => entries.get(curve.key)?.element ?? []),
    );
  }

  /**
   * @param {number} id
   * @param {string} name
   */
  function entry(id, name) {
    const value = el("span", { class: "wv-number wv-chart-value" });
    const problem = el("div", { class: "wv-chart-problem" });
    const own = el("div", { class: "wv-chart-sums wv-quiet wv-number" });
    const swatch = el("span", { class: "wv-chart-swatch" });
    swatch.style.background = color(id);
    const remove = el(
      "button",
      {
        type: "button",
        class: "wv-icon",
        "aria-label": `Remove ${name}`,
        "data-tip": "Remove",
        onclick: () => send(name),
      },
      icon("close", 12),
    );
    const parts = name.split(/(?=[./[{])/).flatMap((part) => [el("wbr"), part]);
    const label = el("span", { class: "wv-chart-name" }, parts);
    const line = el(
      "div",
      { class: "wv-chart-entry" },
      swatch,
      label,
      value,
      needs("UseWidget", remove),
    );
    return { element: el("li", {}, line, own, problem), value, problem, sums: own };
  }

  /**
   * @param {ChartFacts} next
   * @param {ValuesOf<"panel">} store
   * @param {string} id
   */
  function update(next, store, id) {
    facts = next;
    live = curvesOf(facts.curves, store, id, known);
    held &&= held.filter(({ key: one }) => live.some((curve) => curve.key === one));
    if (!held) end = facts.now;
    follow.hidden = !facts.seeks || facts.across >= 0;
    showLegend();
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
