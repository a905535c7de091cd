// Gestures over a track: a drag seeks or, with Shift, selects; the wheel zooms and moves.

import { why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { el, set, setText } from "webviz/dom.js";
import { signal } from "webviz/signals.js";
import { sanitized } from "webviz/sanitize.js";
import { toast } from "webviz/toasts.js";
import { eventText } from "webviz/features/playback/events.js";
import { nearest, placeOf, shareAt, timeAt, zoomed } from "webviz/features/playback/range.js";

/** @import {Signal} from "webviz/signals.js" */
/** @import {LoggedEvent, Range} from "webviz/types.js" */
/** @import {Seeks} from "webviz/features/playback/rewound.js" */

/**
 * @typedef {{counts: number[], counted: Range, bookmarks: [string, number][], events: LoggedEvent[]}} Marks
 *   `counted` are the seconds that the counts are of, `events` are of `events.js`
 */

const WHEEL = 1.25;
const MIN_SPAN_PX = 4;

/**
 * The state of a track; `first` is the earliest time that can be shown.
 *
 * @typedef {{
 *   isThere: () => boolean, range: Signal<Range>, bounds: () => Range, first: () => number,
 *   marks: () => Marks, textOf: (time: number, digits: number) => string,
 * }} TrackState
 */

/** @typedef {{pointer: number, x: number, from: number, isSpan: boolean, span: Range | null}} TrackDrag */

/**
 * Listens to the canvas of a track. Returns `{label, hover(), drag()}`: the element of the label, the
 * time under the pointer, and `{isSpan, span}` of a drag, each null for none; they are read in effects.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {Seeks} seek
 * @param {TrackState} track
 */
export function listenToTrack(canvas, seek, track) {
  const hover = signal(/** @type {number | null} */ (null));
  const drag = signal(/** @type {TrackDrag | null} */ (null));
  const label = makeLabel();

  /** @param {PointerEvent | null} event */
  function point(event) {
    hover.value = event && track.isThere() ? timeUnder(event, track) : null;
    if (!event || hover.value === null) return label.show("");
    const { x, width } = placeIn(event);
    const [first, last] = track.range.value;
    const time = track.textOf(hover.value, last - first < 10 ? 3 : 1);
    label.show(markUnder(event, track)?.text ?? time, x, width);
  }

  /** @param {PointerEvent} event */
  function press(event) {
    if (event.button !== 0 || !track.isThere()) return;
    const reason = why(event.shiftKey ? "SelectSpan" : "Seek");
    if (reason) return toast(reason, { level: "warn", topic: "access" });
    canvas.setPointerCapture(event.pointerId);
    const from = markUnder(event, track)?.time ?? timeUnder(event, track);
    const { pointerId: pointer, clientX: x, shiftKey: isSpan } = event;
    drag.value = { pointer, x, from, isSpan, span: null };
    if (!isSpan) seek.to(from);
  }

  /** @param {PointerEvent} event */
  function move(event) {
    point(event);
    if (drag.value?.pointer !== event.pointerId) return;
    const time = timeUnder(event, track);
    const { isSpan, x, from } = drag.value;
    if (!isSpan) seek.to(time);
    else if (Math.abs(event.clientX - x) >= MIN_SPAN_PX)
      drag.value = { ...drag.value, span: [Math.min(from, time), Math.max(from, time)] };
  }

  /** @param {PointerEvent} event */
  function release(event) {
    if (drag.value?.pointer !== event.pointerId) return;
    const { isSpan, span } = drag.value;
    drag.value = null;
    // A click with Shift selects the whole recording again.
    if (isSpan) act("SelectSpan", { first_s: span?.[0] ?? null, last_s: span?.[1] ?? null });
  }

  canvas.addEventListener("pointerdown", press);
  canvas.addEventListener("pointermove", move);
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", () => point(null));
  canvas.addEventListener("dblclick", () => (track.range.value = track.bounds()));
  canvas.addEventListener("wheel", (event) => zoom(event, track));
  return { label: label.element, hover: () => hover.value, drag: () => drag.value };
}

/** @param {MouseEvent} event on the canvas of a track */
function placeIn({ clientX, currentTarget }) {
  const { left, width } = /** @type {Element} */ (currentTarget).getBoundingClientRect();
  return { x: clientX - left, width };
}

/**
 * @param {MouseEvent} event
 * @param {TrackState} track
 */
function timeUnder(event, track) {
  const { x, width } = placeIn(event);
  return Math.min(Math.max(timeAt(x, track.range.value, width), track.first()), track.bounds()[1]);
}

/**
 * The bookmark, or else the warning or error, under the pointer.
 *
 * @param {MouseEvent} event
 * @param {TrackState} track
 * @returns {{time: number, text: string} | null}
 */
function markUnder(event, track) {
  const { x, width } = placeIn(event);
  /** @param {number} time */
  const place = (time) => placeOf(time, track.range.value, width);
  const { bookmarks, events } = track.marks();
  const bookmark = nearest(bookmarks, ([, time]) => place(time), x);
  if (bookmark) return { time: bookmark[1], text: bookmark[0] };
  const mark = nearest(events, ([time]) => place(time), x);
  return mark && { time: mark[0], text: eventText(mark) };
}

/**
 * The wheel zooms around the pointer, and moves with Shift or sideways.
 *
 * @param {WheelEvent} event
 * @param {TrackState} track
 */
function zoom(event, track) {
  if (!track.isThere()) return;
  event.preventDefault();
  const { x, width } = placeIn(event);
  const around = Math.min(Math.max(shareAt(x, width), 0), 1);
  const isMove = event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY);
  const sign = Math.sign(event.deltaY || event.deltaX);
  const change = isMove ? { move: 0.1 * sign } : { around, by: WHEEL ** sign };
  track.range.value = zoomed(track.range.value, change, track.bounds());
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
