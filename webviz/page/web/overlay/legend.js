// Legends of colours, for each display that colours by value.

import { el } from "webviz/dom.js";
import { each, effect } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { colorBar } from "webviz/charts/color_bar.js";

/** @import {Scale} from "webviz/contents.js" */

const MAX_CARDS = 4;

export function build() {
  const scales = store("legend");
  const cards = each(
    () => [...scales.all()].slice(0, MAX_CARDS),
    ([id]) => id,
    (scale) => card(() => scale.value[1]),
  );
  return el("div", { class: "wv-legends" }, cards);
}

/** @param {() => Scale} scale */
function card(scale) {
  const title = () => scale().title;
  const bar = colorBar();
  effect(() => bar.show(scale().colors));
  const bounds = [() => String(scale().low), () => scale().label, () => String(scale().high)];
  return el(
    "div",
    { class: "wv-card wv-legend" },
    el("div", { "data-tip": title }, title),
    bar.element,
    el(
      "div",
      { class: "wv-legend-bounds" },
      bounds.map((text) => el("span", {}, text)),
    ),
  );
}
