// The legend of a picture that is coloured by value.

import { el } from "webviz/dom.js";
import { colorBar } from "webviz/charts/color_bar.js";
import { effect } from "webviz/signals.js";

/** @import {ColorRange} from "webviz/messages.js" */

/**
 * A legend, hidden without a range.
 *
 * @param {() => ColorRange | undefined} range read in effects
 */
export function makeLegend(range) {
  const text = (/** @type {"low" | "high"} */ end) => () => {
    const { [end]: value = "", unit = "" } = range() ?? {};
    return `${value}${unit && ` ${unit}`}`;
  };
  const bar = colorBar();
  effect(() => bar.show(range()?.colors ?? []));
  return el(
    "div",
    { class: "wv-pane-legend", hidden: () => !range() },
    el("span", {}, text("low")),
    bar.element,
    el("span", {}, text("high")),
  );
}
