// An overlay: the heading of the camera, clockwise from north.

import { setText } from "webviz/dom.js";

/** @import {Page} from "webviz/extensions.js" */

/** @param {Page} page */
export default function install({ beforeRender, canvas, el, groundAt, overlay }) {
  const text = el("div", { class: "wv-card", title: "Heading of the camera" });
  overlay("legend", "compass", text);
  beforeRender(() => {
    const { left, top, width, height } = canvas().getBoundingClientRect();
    const [near, far] = [0.95, 0.75].map((share) =>
      groundAt(left + width / 2, top + height * share),
    );
    text.hidden = !near || !far;
    if (!near || !far) return;
    const degrees = (Math.atan2(far[0] - near[0], far[1] - near[1]) * 180) / Math.PI;
    setText(text, `${Math.round(degrees + 360) % 360}°`);
  });
}
