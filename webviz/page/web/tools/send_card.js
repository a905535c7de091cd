// Asks at the preview of a gesture whether to send it.

import { el } from "webviz/dom.js";
import { textButton } from "webviz/icons.js";
import { canvas } from "webviz/viser_page.js";

/** @import {Vec2} from "webviz/types.js" */

const GAP = 18; // pixels from the start of the gesture
const MARGIN = 8;
const BAR = 96; // of the toolbar and the hint

/**
 * A card with two buttons; `place([x, y], ahead)` puts it below a point of the canvas, or above it if
 * the heading, a point, too, is below. Without a point it is in the middle.
 *
 * @param {() => void} send
 * @param {() => void} cancel
 */
export function sendCard(send, cancel) {
  const first = textButton("Send", send, { class: "wv-button wv-primary" });
  const element = el(
    "div",
    { class: "wv-send wv-card", role: "group", "aria-label": "Send this?" },
    first,
    textButton("Cancel", cancel),
  );
  return {
    element,
    focus: () => first.focus({ preventScroll: true }),
    /**
     * @param {Vec2 | null} point
     * @param {Vec2 | null} ahead
     */
    place(point, ahead) {
      const { clientWidth: width, clientHeight: height } = canvas();
      const { offsetWidth, offsetHeight } = element;
      const [x, y] = point ?? [width / 2, height / 2];
      const left = clamp(x - offsetWidth / 2, MARGIN, width - offsetWidth - MARGIN);
      const isAbove = ahead !== null && ahead[1] > y;
      const beside = isAbove ? y - GAP - offsetHeight : y + GAP;
      const top = clamp(beside, BAR, height - offsetHeight - MARGIN);
      const moved = `translate(${left.toFixed(1)}px, ${top.toFixed(1)}px)`;
      if (element.style.transform !== moved) element.style.transform = moved;
    },
  };
}

/**
 * @param {number} number
 * @param {number} least
 * @param {number} most
 */
const clamp = (number, least, most) => Math.max(least, Math.min(number, most));
