// The widget "indicator": a lamp and its label.

import { el, set, setText, showText } from "webviz/dom.js";

/** @import {Page} from "../page/web/extensions.js" */

/** @type {Record<string, string>} */
const COLORS = {
  green: "#2e9e44",
  yellow: "#e8c100",
  orange: "#e87e04",
  red: "#d32f2f",
  blue: "#2274d6",
  grey: "#8a8f98",
};

/** @param {Page} page */
export default function install({ widget }) {
  widget("indicator", () => {
    const lamp = el("i", { role: "img" });
    const label = el("span");
    const empty = el("div", { class: "wv-empty", role: "status" });
    const element = el("div", {}, el("div", { class: "wv-indicator" }, lamp, label), empty);
    return {
      element,
      update(values) {
        lamp.style.setProperty("--lamp", COLORS[values.color] ?? COLORS.grey);
        set(lamp, { "aria-label": values.color });
        setText(label, values.label ?? "");
        showText(empty, values.problem ?? "");
      },
    };
  });
}
