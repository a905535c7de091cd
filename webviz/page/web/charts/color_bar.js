// The bar of a legend: a scale of colours from the lowest value to the highest.

import { el } from "webviz/dom.js";

/** A bar; `show(colors)` paints red, green and blue of each, if they are others than before. */
export function colorBar() {
  const element = el("div", { class: "wv-legend-bar" });
  let previous = "";
  return {
    element,
    /** @param {readonly (readonly number[])[]} colors */
    show(colors) {
      const stops = colors.map((rgb) => `rgb(${rgb.join()})`).join();
      if (previous !== stops) element.style.background = `linear-gradient(to right, ${stops})`;
      previous = stops;
    },
  };
}
