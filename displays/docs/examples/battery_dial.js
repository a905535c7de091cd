// The widget "dial": a bar with a mark, which a click moves.

import { setText } from "webviz/dom.js";

/** @import {Page} from "webviz/extensions.js" */

/** @param {Page} page */
export default function install({ el, set, widget }) {
  widget("dial", (values, send) => {
    const text = el("span");
    const bar = el("meter", {
      min: 0,
      max: 1,
      "aria-label": "Charge",
      style: "width: 100%; cursor: pointer",
    });
    bar.addEventListener("click", ({ clientX }) => {
      const { left, width } = bar.getBoundingClientRect();
      send((clientX - left) / width);
    });
    function update({ charge = 0, limit = 0 }) {
      set(bar, { value: charge, low: limit });
      const percent = (/** @type {number} */ share) => `${Math.round(share * 100)} %`;
      setText(text, `${percent(charge)}, warns below ${percent(limit)}`);
    }
    return { element: el("div", { style: "display: grid" }, text, bar), update };
  });
}
