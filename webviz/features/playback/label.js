// The label below the pointer over a track.

import { el, set, setText } from "../../dom.js";
import { sanitized } from "../../sanitize.js";

/** A label; `show(text, x, width)` puts it at a place of a track as wide as that, `show("")` hides it. */
export function makeLabel() {
  const element = el("span", { class: "wv-track-label wv-number", hidden: true });
  return {
    element,
    /**
     * @param {string} text
     * @param {number} [x]
     * @param {number} [width]
     */
    show(text, x = 0, width = 0) {
      set(element, { hidden: !text });
      if (!text) return;
      setText(element, sanitized(text));
      const half = element.offsetWidth / 2;
      const left = Math.min(Math.max(x, half), width - half) - half;
      element.style.transform = `translateX(${Math.round(left)}px)`;
    },
  };
}
