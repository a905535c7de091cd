// How long something is where the camera looks at: a bar of a round length.

import { el, setText } from "../dom.js";
import * as views from "../scene/view.js";
import * as viser from "../viser_page.js";

const WIDEST = 110;
/** @type {[string, number][]} */
const UNITS = [["km", 1000], ["m", 1], ["cm", 0.01], ["mm", 0.001]];

/** The largest of 1, 2 and 5 times a power of ten up to a length. */
export function rounded(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].find((digit) => digit * power <= length) * power;
}

/** A length in metres in the unit that suits it. */
export function inWords(meters) {
  const [unit, size] = UNITS.find(([, size]) => meters >= size * 0.9999) ?? UNITS.at(-1);
  return `${Number((meters / size).toPrecision(3))} ${unit}`;
}

export function build() {
  const label = el("span");
  const line = el("div", { class: "wv-scale-line" });
  const bar = el("div", { class: "wv-card wv-scale", title: "At the point the camera looks at" });
  bar.append(line, label);
  viser.beforeRender(() => {
    const perPixel = views.metersPerPixel();
    const length = rounded(WIDEST * perPixel);
    bar.hidden = !(Number.isFinite(length) && length > 0) || views.type() === "FPS";
    if (bar.hidden) return;
    const width = `${Math.round(length / perPixel)}px`;
    if (line.style.width !== width) line.style.width = width;
    setText(label, inWords(length));
  });
  return bar;
}
