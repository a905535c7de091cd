// The topics of a recording, each with the times of its messages below those of the track.

import { rowList } from "webviz/controls/rows.js";
import { el, set, setText } from "webviz/dom.js";
import { watch } from "webviz/stores.js";
import { fitted } from "webviz/charts/canvas.js";
import { placeOf } from "webviz/features/playback/range.js";
import { bars } from "webviz/features/playback/draw.js";

/** @import {Range} from "webviz/types.js" */
/** @typedef {{key: string, counts: number[]}} Strip */

const ROW = 22;

/** @typedef {ReturnType<typeof topics>} Topics */

/**
 * Returns `{element, redraw(), toggle(), isOpen()}`. `range()` and `counted()` are those of the track; `step` is
 * `{topic(), choose(topic)}`: of which topic the next message is shown.
 *
 * @param {{range: () => Range, counted: () => Range, step: {topic(): string, choose(topic: string): void}, toggled: () => void}} timeline
 */
export function topics({ range, counted, step, toggled }) {
  /** @type {(() => void) | null} */
  let end = null;
  /** @type {Strip[]} */
  let items = [];
  const list = rowList({
    label: "Topics of the timeline",
    height: ROW,
    make,
    update,
    choose: ({ key }) => {
      step.choose(key);
      redraw();
    },
  });
  const element = el("div", { class: "wv-recorded", hidden: true }, list.element);

  function make() {
    const canvas = el("canvas", { class: "wv-recorded-strip" });
    const name = el("span", { class: "wv-recorded-name" });
    return Object.assign(el("div", { class: "wv-recorded-row" }, canvas, name), {
      parts: { canvas, name },
    });
  }

  /**
   * @param {HTMLElement & {parts: {canvas: HTMLCanvasElement, name: HTMLElement}}} row
   * @param {Strip} strip
   */
  function update(row, { key, counts }) {
    const { canvas, name } = row.parts;
    setText(name, key || "All displayed topics");
    set(row, { "data-steps": step.topic() === key });
    requestAnimationFrame(() => paint(canvas, counts)); // once it has a size
  }

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {number[]} counts
   */
  function paint(canvas, counts) {
    const { context, height, color } = fitted(canvas);
    // As wide as the track, which has no scroll bar beside it.
    const width = element.clientWidth;
    /** @param {number} time */
    const x = (time) => placeOf(time, range(), width);
    bars(context, counts, {
      x,
      counted: counted(),
      range: range(),
      top: 2,
      height: height - 4,
      color: color("accent"),
    });
  }

  new ResizeObserver(redraw).observe(element);

  function redraw() {
    if (end) list.show(items);
  }

  function toggle() {
    if (end) {
      end();
      end = null;
    } else {
      end = watch("recorded", (recorded) => {
        const names = [...recorded.keys()].sort();
        items = [
          { key: "", counts: [] },
          ...names.map((key) => ({ key, counts: recorded.get(key) ?? [] })),
        ];
        list.show(items);
      });
    }
    set(element, { hidden: !end });
    toggled();
  }

  return { element, redraw, toggle, isOpen: () => end !== null };
}
