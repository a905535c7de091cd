// The legend of a picture that is coloured by value.

import { el, setText } from "webviz/dom.js";
import { colorBar } from "webviz/charts/color_bar.js";

/** @import {ColorRange} from "webviz/messages.js" */

/** A legend; `show(range)` hides it without one. */
export function makeLegend() {
  const [low, high] = [el("span"), el("span")];
  const bar = colorBar();
  const element = el("div", { class: "wv-pane-legend", hidden: true }, low, bar.element, high);
  return {
    element,
    /** @param {ColorRange | undefined} range */
    show(range) {
      element.hidden = !range;
      if (!range) return;
      setText(low, `${range.low}${range.unit && ` ${range.unit}`}`);
      setText(high, `${range.high}${range.unit && ` ${range.unit}`}`);
      bar.show(range.colors);
    },
  };
}
