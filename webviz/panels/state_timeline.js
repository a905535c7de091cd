// The widget "states": bands over time, whose colours stand for values.

import { fitted } from "webviz/charts/canvas.js";
import { el, set, setChildren, setText, showText } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { timeOfDay } from "webviz/time_text.js";

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
  widget("states", (_, send) => {
    let [start, end] = [0, 1];
    const empty = el(
      "div",
      { class: "wv-empty", role: "status" },
      "Add a field with +, or drag one here from Topics.",
    );
    const place = el("div", { class: "wv-states" });
    /** @type {Map<string, ReturnType<typeof make>>} */
    const made = new Map();

    /** @param {string} name */
    function make(name) {
      /** @type {Track} */
      let shown = { name, problem: "", times: [], states: [] };
      const said = el("span", { class: "wv-quiet" });
      /** @type {HTMLCanvasElement} */
      const canvas = el("canvas", {
        role: "img",
        "aria-label": name,
        onpointermove: (event) => point(timeAt(event)),
        onpointerleave: () => point(null),
        onclick: (event) => send(timeAt(event)),
      });
      const problem = el("div", { class: "wv-quiet" });

      /**
       * @param {MouseEvent} event
       * @returns {number}
       */
      function timeAt({ clientX }) {
        const { left, width } = canvas.getBoundingClientRect();
        return start + ((clientX - left) / width) * (end - start);
      }

      /** @param {number | null} time */
      function point(time) {
        const at = time ?? Infinity;
        const i = shown.times.findLastIndex((each) => each <= at);
        const text = i < 0 ? "" : shown.states[i];
        setText(said, time === null ? text : `${text} · ${timeOfDay(at, true)}`);
      }

      function draw() {
        const { context, width, height } = fitted(canvas);
        const { times, states } = shown;
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

      return {
        element: el(
          "div",
          {},
          el(
            "div",
            { class: "wv-states-name" },
            el("span", { class: "wv-ellipsis", "data-tip": name }, name),
            said,
            iconButton("close", `Remove ${name}`, () => send(name)),
          ),
          canvas,
          problem,
        ),
        /** @param {Track} track */
        update(track) {
          shown = track;
          showText(problem, track.problem);
          if (!canvas.matches(":hover")) point(null);
          draw();
        },
      };
    }

    return {
      element: el("div", {}, empty, place),
      /** @param {{start: number, end: number, tracks: Track[]}} values */
      update({ start: from = 0, end: to = 1, tracks = [] }) {
        [start, end] = [from, to];
        for (const name of made.keys())
          if (!tracks.some((track) => track.name === name)) made.delete(name);
        for (const { name } of tracks) if (!made.has(name)) made.set(name, make(name));
        setChildren(
          place,
          tracks.flatMap(({ name }) => made.get(name)?.element ?? []),
        );
        for (const track of tracks) made.get(track.name)?.update(track);
        set(empty, { hidden: tracks.length > 0 });
      },
    };
  });
}
