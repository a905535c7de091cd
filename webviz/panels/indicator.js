// The widget "indicator": a lamp and its label.

import { el, set, setText, showText } from "webviz/dom.js";

/** @import {Page} from "../page/web/extensions.js" */

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
        set(lamp, { "aria-label": values.color, "data-color": values.color });
        setText(label, values.label ?? "");
        showText(empty, values.problem ?? "");
      },
    };
  });
}
