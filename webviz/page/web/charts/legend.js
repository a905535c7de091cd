// The legend of a chart: what each curve is called, its value at a time, and sums of what is in sight.

import { needs } from "webviz/access.js";
import { el, setChildren, setText } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { sumsText, valueText } from "webviz/charts/readings.js";

/** @import {Curve, Range} from "webviz/types.js" */

const HUES = [210, 28, 140, 0, 270, 180, 60, 320, 100, 240, 15, 160];

/** @param {number} key of a curve */
export const colorOf = (key) => `hsl(${HUES[key % HUES.length]} 75% 55%)`;

/**
 * A legend; `remove(name)` removes a curve.
 *
 * @param {(name: string) => unknown} remove
 */
export function makeLegend(remove) {
  /** @type {Map<number, ReturnType<typeof entry>>} */
  const entries = new Map();
  const element = el("ul", { class: "wv-chart-legend" });

  /** @param {Curve} curve */
  function entry({ key, name }) {
    const value = el("span", { class: "wv-number wv-chart-value" });
    const problem = el("div", { class: "wv-chart-problem" });
    const sums = el("div", { class: "wv-chart-sums wv-quiet wv-number" });
    const swatch = el("span", { class: "wv-chart-swatch" });
    swatch.style.background = colorOf(key);
    const button = iconButton("close", `Remove ${name}`, () => remove(name), {
      tip: "Remove",
      size: 12,
    });
    const line = el(
      "div",
      { class: "wv-chart-entry" },
      swatch,
      el("span", { class: "wv-chart-name", "data-tip": name }, el("bdi", {}, name)),
      value,
      needs("UseWidget", button),
    );
    return { element: el("li", {}, line, sums, problem), value, problem, sums };
  }

  return {
    element,
    /** @param {Curve[]} curves all that there are */
    show(curves) {
      for (const key of entries.keys())
        if (!curves.some((curve) => curve.key === key)) entries.delete(key);
      const children = curves.map((curve) => {
        const item = entries.get(curve.key) ?? entry(curve);
        entries.set(curve.key, item);
        setText(item.problem, curve.problem);
        return item.element;
      });
      setChildren(element, children);
    },
    /**
     * @param {Curve[]} curves
     * @param {number} time
     * @param {Range | null} span of the statistics, null without them
     */
    read(curves, time, span) {
      for (const curve of curves) {
        const item = entries.get(curve.key);
        if (!item) continue;
        setText(item.value, valueText(curve, time));
        setText(item.sums, span ? sumsText(curve, span) : "");
      }
    },
  };
}
