// The widget "raw": a message as rows that fold.

import { el, showText } from "webviz/dom.js";
import { messageRows } from "webviz/panels/message_rows.js";

/** @import {Page} from "../page/web/extensions.js" */

/** @param {Page} page */
export default function install({ widget }) {
  widget("raw", () => {
    let path = "";
    const empty = el("div", { class: "wv-empty", role: "status" });
    const tree = messageRows({ label: "Message", topic: () => path });
    const element = el("div", { class: "wv-plugin-fill" }, empty, tree.element);
    return {
      element,
      update(values) {
        path = values.path ?? "";
        tree.show(values.tree ?? null);
        showText(empty, values.problem ?? "");
      },
      close: tree.close,
    };
  });
}
