// The track of the timeline: a slider over the whole recording that is zoomed by the wheel.

import { why } from "../access.js";
import { act } from "../act.js";
import { at, share } from "../charts/scale.js";
import { el, set, setText } from "../dom.js";
import { sanitized } from "../sanitize.js";
import { toast } from "../shell/toasts.js";
import { duration } from "../shell/time_text.js";
import { draw, MARGIN } from "./draw.js";
import { eventText } from "./events.js";
import { beforeText } from "./moment.js";
import { following, shownLength, zoomed } from "./range.js";

/** @import {LoggedEvent, Moment, Range} from "../types.js" */
/** @import {Seeks} from "./seeks.js" */

const WHEEL = 1.25;
const MIN_SPAN_PX = 4;
const SNAP_PX = 5;

/**
 * The first and the last second of the whole track: of live topics, what the memory can hold.
 *
 * @param {Moment} recording
 * @returns {Range}
 */
function boundsOf(recording) {
  const last = recording.get("duration");
  if (recording.get("is_live") === null) return [0, shownLength(last)];
  const limit = recording.get("limit");
  return [Math.min(recording.get("first"), recording.get("is_live") ? last - limit : last), last];
}

/**
 * Returns `{element, range, counted, length, show(recording), setCounts(counts, span), setBookmarks(bookmarks), setEvents(events)}`:
 * `seek` is of `seeks.js`, `recording` the store "playback", a Map, `events` are of `events.js`. `redrawn()`
 * is called when the window is another.
 *
 * @param {Seeks} seek
 * @param {() => void} [redrawn]
 */
export function track(seek, redrawn = () => {}) {
  /** @type {Moment | null} */
  let recording = null;
  /** @type {number[]} */
  let counts = [];
  /** @type {Range} */
  let counted = [0, 1]; // the seconds that they are of
  /** @type {[string, number][]} */
  let bookmarks = [];
  /** @type {LoggedEvent[]} */
  let events = [];
  /** @type {Range} */
  let bounds = [0, 1]; // of the whole track, in seconds
  /** @type {Range} */
  let range = bounds; // the window
  /** @type {number | null} */
  let hover = null;
  /** @type {{pointer: number, x: number, from: number, isSpan: boolean, span: Range | null} | null} */
  let drag = null; // {pointer, from, isSpan}
  let frame = 0;

  const canvas = el("canvas", {
    class: "wv-track",
    role: "slider",
    tabindex: 0,
    "aria-label": "Time of the recording",
    "aria-description": "Click or drag to seek, Shift+drag to select what is played, wheel to zoom",
    onpointerdown: press,
    onpointermove: move,
    onpointerup: release,
    onpointercancel: release,
    onpointerleave: () => point(null),
    onwheel: wheel,
    ondblclick: () => setRange(bounds),
  });
  const label = el("span", { class: "wv-track-label wv-number", hidden: true });
  const element = el("div", { class: "wv-track-place" }, canvas, label);
  new ResizeObserver(later).observe(canvas);

  const position = () => seek.wanted() ?? recording?.get("position") ?? 0;

  /** @param {Moment} next */
  function show(next) {
    recording = next;
    const whole = boundsOf(recording);
    if (whole[0] !== bounds[0] || whole[1] !== bounds[1]) {
      const isWhole = range[0] === bounds[0] && range[1] === bounds[1];
      const isOther = isBag() || whole[0] > range[0];
      bounds = whole;
      if (isWhole || isOther) setRange(whole);
    }
    if (recording.get("is_playing") && !drag) follow();
    set(canvas, {
      "aria-valuemin": bounds[0],
      "aria-valuemax": bounds[1],
      "aria-valuenow": position(),
      "aria-valuetext": textOf(position()),
    });
    later();
  }

  const isBag = () => recording?.get("is_live") === null;
  // Live topics are counted back from now.
  /**
   * @param {number} time
   * @param {number} [digits]
   */
  const textOf = (time, digits = 1) =>
    isBag() ? duration(time, digits) : beforeText(time - recording?.get("duration"), digits);
  /**
   * @param {Range} window
   * @param {number} by
   * @returns {Range}
   */
  const moved = ([first, last], by) => [first + by, last + by];

  function follow() {
    const next = moved(
      following(moved(range, -bounds[0]), position() - bounds[0], bounds[1] - bounds[0]),
      bounds[0],
    );
    if (next[0] !== range[0]) setRange(next);
  }

  /** @param {Range} next */
  function setRange(next) {
    range = next;
    later();
    redrawn();
  }

  function later() {
    frame ||= requestAnimationFrame(() => {
      frame = 0;
      if (!recording || !canvas.clientWidth) return;
      const selected = drag?.isSpan ? drag.span : recording?.get("selected");
      const past =
        isBag() || !recording
          ? null
          : {
              first: recording.get("first"),
              now: recording.get("duration"),
              gap: recording.get("gap"),
            };
      draw(canvas, {
        range,
        counted,
        counts,
        selected,
        bookmarks,
        events,
        past,
        position: position(),
        hover,
      });
    });
  }

  // The time at a pointer.
  /**
   * @param {MouseEvent} event
   * @returns {number}
   */
  function timeAt({ clientX }) {
    const { left, width } = canvas.getBoundingClientRect();
    const part = (clientX - left - MARGIN) / Math.max(1, width - 2 * MARGIN);
    return Math.min(Math.max(at(part, range), recording?.get("first")), bounds[1]);
  }

  // The bookmark, or else the nearest warning or error, at a pointer: `{time, text}`.
  /**
   * @param {MouseEvent} event
   * @returns {{time: number, text: string} | null}
   */
  function markAt({ clientX }) {
    const { left, width } = canvas.getBoundingClientRect();
    /** @param {number} time */
    const place = (time) => left + MARGIN + share(time, range) * (width - 2 * MARGIN);
    /** @param {number} time */
    const away = (time) => Math.abs(place(time) - clientX);
    const bookmark = bookmarks.find(([, time]) => away(time) <= SNAP_PX);
    if (bookmark) return { time: bookmark[1], text: bookmark[0] };
    /** @type {LoggedEvent | null} */
    let found = null;
    let least = SNAP_PX;
    for (const event of events) {
      const distance = away(event[0]);
      if (distance > least || (found && distance === least)) continue;
      found = event;
      least = distance;
    }
    return found && { time: found[0], text: eventText(found) };
  }

  /**
   * @param {PointerEvent} event
   * @returns {void}
   */
  function press(event) {
    if (event.button !== 0 || !recording) return;
    const reason = why(event.shiftKey ? "SelectSpan" : "Seek");
    if (reason) {
      toast(reason, { level: "warn", topic: "access" });
      return;
    }
    canvas.setPointerCapture(event.pointerId);
    const from = markAt(event)?.time ?? timeAt(event);
    drag = { pointer: event.pointerId, x: event.clientX, from, isSpan: event.shiftKey, span: null };
    if (!drag.isSpan) seek.to(from);
  }

  /**
   * @param {PointerEvent} event
   * @returns {void}
   */
  function move(event) {
    point(event);
    if (drag?.pointer !== event.pointerId) return;
    const time = timeAt(event);
    if (!drag.isSpan) seek.to(time);
    else if (Math.abs(event.clientX - drag.x) >= MIN_SPAN_PX) {
      drag.span = [Math.min(drag.from, time), Math.max(drag.from, time)];
    }
    later();
  }

  /**
   * @param {PointerEvent} event
   * @returns {void}
   */
  function release(event) {
    if (drag?.pointer !== event.pointerId) return;
    const { isSpan, span } = drag;
    drag = null;
    // A click with Shift selects the whole recording again.
    if (isSpan) act("SelectSpan", { first_s: span?.[0] ?? null, last_s: span?.[1] ?? null });
    later();
  }

  /**
   * @param {PointerEvent | null} event
   * @returns {void}
   */
  function point(event) {
    hover = event && recording ? timeAt(event) : null;
    set(label, { hidden: hover === null });
    if (event && hover !== null) {
      const text = textOf(hover, range[1] - range[0] < 10 ? 3 : 1);
      setText(label, sanitized(markAt(event)?.text ?? text));
      const { left, width } = canvas.getBoundingClientRect();
      const half = label.offsetWidth / 2;
      const x = Math.min(Math.max(event.clientX - left, half), width - half);
      label.style.transform = `translateX(${Math.round(x - half)}px)`;
    }
    later();
  }

  /**
   * @param {WheelEvent} event
   * @returns {void}
   */
  function wheel(event) {
    if (!recording) return;
    event.preventDefault();
    const { left, width } = canvas.getBoundingClientRect();
    const around = Math.min(Math.max((event.clientX - left - MARGIN) / (width - 2 * MARGIN), 0), 1);
    const isMove = event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY);
    const sign = Math.sign(event.deltaY || event.deltaX);
    const change = isMove ? { move: 0.1 * sign } : { around, by: WHEEL ** sign };
    setRange(moved(zoomed(moved(range, -bounds[0]), change, bounds[1] - bounds[0]), bounds[0]));
  }

  return {
    element,
    range: () => range,
    counted: () => counted,
    length: () => range[1] - range[0],
    show,
    /**
     * @param {number[]} next
     * @param {Range} span
     */
    setCounts(next, span) {
      counts = next;
      counted = span;
      later();
      redrawn();
    },
    /** @param {[string, number][]} next */
    setBookmarks(next) {
      bookmarks = next;
      later();
    },
    /** @param {LoggedEvent[]} next */
    setEvents(next) {
      events = next;
      later();
    },
  };
}
