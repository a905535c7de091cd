// The head of the side: the config file, and what is done with it.

import { el, setText } from "../dom.js";
import { watch } from "../stores.js";

export function build() {
  const name = el("span", { class: "wv-file" });
  const mark = el("span", { class: "wv-mark", title: "Unsaved changes" });
  watch("file", (file) => {
    const path = file.get("path") ?? "";
    setText(name, path.split("/").pop() || "webviz");
    mark.hidden = !file.get("is_changed");
    document.title = `${mark.hidden ? "" : "* "}${path ? `${name.textContent} · ` : ""}webviz`;
  });
  return el("header", { class: "wv-head" }, name, mark);
}
