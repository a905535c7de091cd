// Gestures over a track: a drag seeks or, with Shift, selects; the wheel zooms and moves.

import { why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { el, set, setText } from "webviz/dom.js";
import { sanitized } from "webviz/sanitize.js";
import { toast } from "webviz/toasts.js";
import { eventText } from "webviz/features/playback/events.js";
import { nearest, placeOf, shareAt, timeAt, zoomed } from "webviz/features/playback/range.js";

/** @import {LoggedEvent, Range} from "webviz/types.js" */
/** @import {Seeks} from "webviz/features/playback/rewound.js" */

/**
 * @typedef {{counts: number[], counted: Range, bookmarks: [string, number][], events: LoggedEvent[]}} Marks
 *   `counted` are the seconds that the counts are of, `events` are of `events.js`
 */

const WHEEL = 1.25;
const MIN_SPAN_PX = 4;

/**
 * Listens to the canvas of a track; `redraw` is called when something else is pointed at or selected.
 * Returns `{label, hover(), drag()}`: the element of the label, the time under the pointer, and
 * `{isSpan, span}` of a drag, each null for none.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {Seeks} seek
 * @param {{
 *   isThere: () => boolean, range: () => Range, setRange: (range: Range) => void,
 *   bounds: () => Range, first: () => number, marks: () => Marks,
 *   textOf: (time: number, digits: number) => string, redraw: () => void,
 * }} track `first` is the earliest time that can be shown
 */
export function listenToTrack(canvas, seek, track) {
  /** @type {number | null} */
  let hover = null;
  /** @type {{pointer: number, x: number, from: number, isSpan: boolean, span: Range | null} | null} */
  let drag = null;
  const label = makeLabel();

  /** @param {MouseEvent} event */
  function placeAt({ clientX }) {
    const { left, width } = canvas.getBoundingClientRect();
    return { x: clientX - left, width };
  }

  /** @param {MouseEvent} event */
  function pointed(event) {
    const { x, width } = placeAt(event);
    return Math.min(Math.max(timeAt(x, track.range(), width), track.first()), track.bounds()[1]);
  }

  // The bookmark, or else the warning or error, at a pointer.
  /**
   * @param {MouseEvent} event
   * @returns {{time: number, text: string} | null}
   */
  function markAt(event) {
    const { x, width } = placeAt(event);
    /** @param {number} time */
    const place = (time) => placeOf(time, track.range(), width);
    const { bookmarks, events } = track.marks();
    const bookmark = nearest(bookmarks, ([, time]) => place(time), x);
    if (bookmark) return { time: bookmark[1], text: bookmark[0] };
    const found = nearest(events, ([time]) => place(time), x);
    return found && { time: found[0], text: eventText(found) };
  }

  /** @param {PointerEvent | null} event */
  function point(event) {
    hover = event && track.isThere() ? pointed(event) : null;
    if (!event || hover === null) label.show("");
    else {
      const { x, width } = placeAt(event);
      const [first, last] = track.range();
      const text = markAt(event)?.text ?? track.textOf(hover, last - first < 10 ? 3 : 1);
      label.show(text, x, width);
    }
    track.redraw();
  }

  /** @param {PointerEvent} event */
  function release(event) {
    if (drag?.pointer !== event.pointerId) return;
    const { isSpan, span } = drag;
    drag = null;
    // A click with Shift selects the whole recording again.
    if (isSpan) act("SelectSpan", { first_s: span?.[0] ?? null, last_s: span?.[1] ?? null });
    track.redraw();
  }

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || !track.isThere()) return;
    const reason = why(event.shiftKey ? "SelectSpan" : "Seek");
    if (reason) return toast(reason, { level: "warn", topic: "access" });
    canvas.setPointerCapture(event.pointerId);
    const from = markAt(event)?.time ?? pointed(event);
    drag = { pointer: event.pointerId, x: event.clientX, from, isSpan: event.shiftKey, span: null };
    if (!drag.isSpan) seek.to(from);
  });
  canvas.addEventListener("pointermove", (event) => {
    point(event);
    if (drag?.pointer !== event.pointerId) return;
    const time = pointed(event);
    if (!drag.isSpan) seek.to(time);
    else if (Math.abs(event.clientX - drag.x) >= MIN_SPAN_PX)
      drag.span = [Math.min(drag.from, time), Math.max(drag.from, time)];
  });
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", () => point(null));
  canvas.addEventListener("dblclick", () => track.setRange(track.bounds()));
  canvas.addEventListener("wheel", (event) => {
    if (!track.isThere()) return;
    event.preventDefault();
    const { x, width } = placeAt(event);
    const around = Math.min(Math.max(shareAt(x, width), 0), 1);
    const isMove = event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY);
    const sign = Math.sign(event.deltaY || event.deltaX);
    const change = isMove ? { move: 0.1 * sign } : { around, by: WHEEL ** sign };
    track.setRange(zoomed(track.range(), change, track.bounds()));
  });
  return { label: label.element, hover: () => hover, drag: () => drag };
}

/** A label of the pointer over a track; `show(text, x, width)` puts it at a place of a track as wide as that, `show("")` hides it. */
function makeLabel() {
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
