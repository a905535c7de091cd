// The scale where the camera looks at: a bar of a round length.

import { el, setText } from "webviz/dom.js";
import * as views from "webviz/scene/view.js";
import * as viser from "webviz/viser_page.js";
import { inWords, rounded } from "webviz/overlay/lengths.js";

const WIDEST = 110;

export function build() {
  const label = el("span");
  const line = el("div", { class: "wv-scale-line" });
  const bar = el("div", { class: "wv-card wv-scale", title: "At the point the camera looks at" });
  bar.append(line, label);
  viser.beforeRender(() => {
    const perPixel = views.metersPerPixel();
    const length = rounded(WIDEST * perPixel);
    bar.hidden = !(Number.isFinite(length) && length > 0) || views.isFPS();
    if (bar.hidden) return;
    const width = `${Math.round(length / perPixel)}px`;
    if (line.style.width !== width) line.style.width = width;
    setText(label, inWords(length));
  });
  return bar;
}
