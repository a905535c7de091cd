// Credits for what the scene shows, such as to the makers of a map.

import { el, setText } from "webviz/dom.js";
import { watch } from "webviz/stores.js";

export function build() {
  const line = el("div", { class: "wv-card wv-attribution" });
  line.hidden = true;
  watch("attributions", (values) => {
    const texts = values.get("texts") ?? [];
    line.hidden = !texts.length;
    setText(line, texts.join(" · "));
  });
  return line;
}
