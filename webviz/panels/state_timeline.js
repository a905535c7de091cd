// The widget "states": bands over time, whose colours stand for values.

import { fitted } from "webviz/charts/canvas.js";
import { el } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { computed, each, effect, signal } from "webviz/signals.js";
import { timeOfDay } from "webviz/time_text.js";
import { oncePerFrame } from "webviz/timing.js";

/** @import {Readable, Signal} from "../page/web/signals.js" */
/** @import {Page} from "../page/web/extensions.js" */

/** @typedef {{name: string, problem: string, times: number[], states: string[]}} Track */

/**
 * The same colour for the same value, whatever else there is.
 *
 * @param {string} text
 */
function colorOf(text) {
  let hash = 7;
  for (const letter of text) hash = (hash * 31 + (letter.codePointAt(0) ?? 0)) % 360;
  return `hsl(${(hash * 47) % 360} 55% 45%)`;
}

/** @param {Page} page */
export default function install({ widget }) {
  widget("states", (_, send) => states(send));
}

/** @param {(value: string | number) => unknown} send */
function states(send) {
  const latest = signal({ span: [0, 1], tracks: /** @type {Track[]} */ ([]) });
  const span = computed(() => latest.value.span);
  const tracks = () => latest.value.tracks;
  const isEmpty = () => !tracks().length;
  return {
    element: el(
      "div",
      {},
      el(
        "div",
        { class: "wv-empty", role: "status", hidden: () => !isEmpty() },
        "Add a field with +, or drag one here from Topics.",
      ),
      el(
        "div",
        { class: "wv-states" },
        each(
          tracks,
          ({ name }) => name,
          (track, name) => bands(name, track, span, send),
        ),
      ),
    ),
    /** @param {{start: number, end: number, tracks: Track[]}} values */
    update({ start = 0, end = 1, tracks = [] }) {
      latest.value = { span: [start, end], tracks };
    },
  };
}

/**
 * The bands of one field.
 *
 * @param {string} name
 * @param {Signal<Track>} track
 * @param {Readable<number[]>} span first and last time
 * @param {(value: string | number) => unknown} send
 */
function bands(name, track, span, send) {
  const pointed = signal(/** @type {number | null} */ (null));
  /** @param {MouseEvent} event */
  const timeAt = ({ clientX }) => {
    const { left, width } = canvas.getBoundingClientRect();
    const [start, end] = span.value;
    return start + ((clientX - left) / width) * (end - start);
  };
  /** @type {HTMLCanvasElement} */
  const canvas = el("canvas", {
    role: "img",
    "aria-label": name,
    onpointermove: (event) => (pointed.value = timeAt(event)),
    onpointerleave: () => (pointed.value = null),
    onclick: (event) => send(timeAt(event)),
  });
  const draw = oncePerFrame(() => drawBands(canvas, track.value, span.value));
  effect(() => {
    if (track.value && span.value) draw();
  });
  const valueText = () => {
    const at = pointed.value ?? Infinity;
    const i = track.value.times.findLastIndex((each) => each <= at);
    const text = i < 0 ? "" : track.value.states[i];
    return pointed.value === null ? text : `${text} · ${timeOfDay(at, true)}`;
  };
  const problem = () => track.value.problem;
  return el(
    "div",
    {},
    el(
      "div",
      { class: "wv-states-name" },
      el("span", { class: "wv-ellipsis", "data-tip": name }, name),
      el("span", { class: "wv-quiet" }, valueText),
      iconButton("close", `Remove ${name}`, () => send(name)),
    ),
    canvas,
    el("div", { class: "wv-quiet", hidden: () => !problem() }, problem),
  );
}

/**
 * @param {HTMLCanvasElement} canvas
 * @param {Track} track
 * @param {number[]} span first and last time
 */
function drawBands(canvas, { times, states }, [start, end]) {
  const { context, width, height } = fitted(canvas);
  /** @param {number} time */
  const x = (time) => ((time - start) / (end - start)) * width;
  context.font = "12px system-ui, sans-serif";
  context.textBaseline = "middle";
  times.forEach((time, i) => {
    const left = Math.max(0, x(time));
    const right = i + 1 < times.length ? x(times[i + 1]) : width;
    if (right <= 0 || left >= width) return;
    context.fillStyle = colorOf(states[i]);
    context.fillRect(left, 0, Math.max(1, right - left), height);
    if (right - left < 24) return;
    context.save();
    context.beginPath();
    context.rect(left, 0, right - left - 4, height);
    context.clip();
    context.fillStyle = "#fff";
    context.fillText(states[i], left + 6, height / 2);
    context.restore();
  });
}
