// The topics of a recording, each with the times of its messages below those of the track.

import { rowList } from "webviz/controls/rows.js";
import { el } from "webviz/dom.js";
import { effect, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { fitted } from "webviz/charts/canvas.js";
import { oncePerFrame } from "webviz/timing.js";
import { placeOf } from "webviz/features/playback/range.js";
import { bars } from "webviz/features/playback/draw.js";

/** @import {Signal} from "webviz/signals.js" */
/** @import {Range} from "webviz/types.js" */
/** @typedef {{key: string, counts: number[]}} Strip */

const ROW = 22;

const recorded = store("recorded");

/** @typedef {ReturnType<typeof topics>} Topics */

/**
 * Returns `{element, toggle(), isOpen()}`. `range()` and `counted()` are those of the track, and `topic`
 * is the one of which the next message is shown; all are read in effects.
 *
 * @param {{range: () => Range, counted: () => Range, topic: Signal<string>}} timeline
 */
export function topics({ range, counted, topic }) {
  const isOpen = signal(false);
  const width = signal(0);

  /** @param {() => Strip} strip */
  function row(strip) {
    const canvas = el("canvas", { class: "wv-recorded-strip" });
    const paint = oncePerFrame(() => {
      const { context, height, color } = fitted(canvas);
      bars(context, strip().counts, {
        // As wide as the track, which has no scroll bar beside it.
        x: (time) => placeOf(time, range(), width.value),
        counted: counted(),
        range: range(),
        top: 2,
        height: height - 4,
        color: color("accent"),
      });
    });
    effect(() => {
      if (strip() && range() && counted() && width.value) paint(); // once it has a size
    });
    return el(
      "div",
      { class: "wv-recorded-row", "data-steps": () => topic.value === strip().key },
      canvas,
      el("span", { class: "wv-recorded-name" }, () => strip().key || "All displayed topics"),
    );
  }

  const list = rowList({
    label: "Topics of the timeline",
    height: ROW,
    row,
    choose: ({ key }) => (topic.value = key),
  });
  const element = el("div", { class: "wv-recorded", hidden: () => !isOpen.value }, list.element);
  effect(() => {
    if (isOpen.value) list.show(strips());
  });
  new ResizeObserver(() => (width.value = element.clientWidth)).observe(element);

  return {
    element,
    toggle: () => (isOpen.value = !isOpen.value),
    isOpen: () => isOpen.value,
  };
}

/** @returns {Strip[]} */
const strips = () => [
  { key: "", counts: [] },
  ...[...recorded.all()]
    .sort(([a], [b]) => (a < b ? -1 : 1))
    .map(([key, counts]) => ({ key, counts })),
];
