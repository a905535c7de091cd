// The track of the timeline: a slider over the whole recording that is zoomed by the wheel.

import { why } from "../access.js";
import { act } from "../act.js";
import { el, set } from "../dom.js";
import { toast } from "../shell/toasts.js";
import { duration } from "../shell/time_text.js";
import { nearest, placeOf, shareAt, timeAt } from "./axis.js";
import { draw } from "./draw.js";
import { eventText } from "./events.js";
import { makeLabel } from "./label.js";
import { beforeText } from "./moment.js";
import { boundsOf, following, isSame, rebounded, zoomed } from "./range.js";

/** @import {LoggedEvent, Moment, Range} from "../types.js" */
/** @import {Seeks} from "./seeks.js" */

/**
 * @typedef {{counts: number[], counted: Range, bookmarks: [string, number][], events: LoggedEvent[]}} Marks
 *   `counted` are the seconds that the counts are of, `events` are of `events.js`
 */

const WHEEL = 1.25;
const MIN_SPAN_PX = 4;

/**
 * Returns `{element, range(), counted(), length(), show(recording), mark(marks)}`: `seek` is of `seeks.js`,
 * `recording` the store "playback", a Map. `redrawn()` is called when the window is another.
 *
 * @param {Seeks} seek
 * @param {() => void} [redrawn]
 */
export function track(seek, redrawn = () => {}) {
  /** @type {Moment | null} */
  let recording = null;
  /** @type {Marks} */
  let marks = { counts: [], counted: [0, 1], bookmarks: [], events: [] };
  /** @type {Range} */
  let bounds = [0, 1]; // of the whole track, in seconds
  /** @type {Range} */
  let range = bounds; // the window
  /** @type {number | null} */
  let hover = null;
  /** @type {{pointer: number, x: number, from: number, isSpan: boolean, span: Range | null} | null} */
  let drag = null;
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
  const label = makeLabel();
  const element = el("div", { class: "wv-track-place" }, canvas, label.element);
  new ResizeObserver(later).observe(canvas);

  const position = () => seek.wanted() ?? recording?.get("position") ?? 0;
  const isBag = () => recording?.get("is_live") === null;
  // Live topics are counted back from now.
  /** @param {number} time @param {number} digits */
  const textOf = (time, digits) =>
    isBag() ? duration(time, digits) : beforeText(time - recording?.get("duration"), digits);

  /** @param {Moment} next */
  function show(next) {
    recording = next;
    const before = bounds;
    bounds = boundsOf(recording);
    let window = rebounded(range, before, bounds, isBag());
    if (recording.get("is_playing") && !drag) window = following(window, position(), bounds);
    if (!isSame(window, range)) setRange(window);
    set(canvas, {
      "aria-valuemin": bounds[0],
      "aria-valuemax": bounds[1],
      "aria-valuenow": position(),
      "aria-valuetext": textOf(position(), 1),
    });
    later();
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
      const [first, now, gap] = ["first", "duration", "gap"].map((key) => recording?.get(key));
      draw(canvas, {
        ...marks,
        range,
        selected: drag?.isSpan ? drag.span : recording.get("selected"),
        past: isBag() ? null : { first, now, gap },
        position: position(),
        hover,
      });
    });
  }

  /** @param {MouseEvent} event */
  function placeAt({ clientX }) {
    const { left, width } = canvas.getBoundingClientRect();
    return { x: clientX - left, width };
  }

  /** @param {MouseEvent} event */
  function pointed(event) {
    const { x, width } = placeAt(event);
    return Math.min(Math.max(timeAt(x, range, width), recording?.get("first")), bounds[1]);
  }

  // The bookmark, or else the warning or error, at a pointer.
  /**
   * @param {MouseEvent} event
   * @returns {{time: number, text: string} | null}
   */
  function markAt(event) {
    const { x, width } = placeAt(event);
    const bookmark = nearest(marks.bookmarks, ([, time]) => placeOf(time, range, width), x);
    if (bookmark) return { time: bookmark[1], text: bookmark[0] };
    const found = nearest(marks.events, ([time]) => placeOf(time, range, width), x);
    return found && { time: found[0], text: eventText(found) };
  }

  /** @param {PointerEvent} event */
  function press(event) {
    if (event.button !== 0 || !recording) return;
    const reason = why(event.shiftKey ? "SelectSpan" : "Seek");
    if (reason) return toast(reason, { level: "warn", topic: "access" });
    canvas.setPointerCapture(event.pointerId);
    const from = markAt(event)?.time ?? pointed(event);
    drag = { pointer: event.pointerId, x: event.clientX, from, isSpan: event.shiftKey, span: null };
    if (!drag.isSpan) seek.to(from);
  }

  /** @param {PointerEvent} event */
  function move(event) {
    point(event);
    if (drag?.pointer !== event.pointerId) return;
    const time = pointed(event);
    if (!drag.isSpan) seek.to(time);
    else if (Math.abs(event.clientX - drag.x) >= MIN_SPAN_PX)
      drag.span = [Math.min(drag.from, time), Math.max(drag.from, time)];
    later();
  }

  /** @param {PointerEvent} event */
  function release(event) {
    if (drag?.pointer !== event.pointerId) return;
    const { isSpan, span } = drag;
    drag = null;
    // A click with Shift selects the whole recording again.
    if (isSpan) act("SelectSpan", { first_s: span?.[0] ?? null, last_s: span?.[1] ?? null });
    later();
  }

  /** @param {PointerEvent | null} event */
  function point(event) {
    hover = event && recording ? pointed(event) : null;
    if (!event || hover === null) label.show("");
    else {
      const { x, width } = placeAt(event);
      const text = markAt(event)?.text ?? textOf(hover, range[1] - range[0] < 10 ? 3 : 1);
      label.show(text, x, width);
    }
    later();
  }

  /** @param {WheelEvent} event */
  function wheel(event) {
    if (!recording) return;
    event.preventDefault();
    const { x, width } = placeAt(event);
    const around = Math.min(Math.max(shareAt(x, width), 0), 1);
    const isMove = event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY);
    const sign = Math.sign(event.deltaY || event.deltaX);
    setRange(zoomed(range, isMove ? { move: 0.1 * sign } : { around, by: WHEEL ** sign }, bounds));
  }

  return {
    element,
    range: () => range,
    counted: () => marks.counted,
    length: () => range[1] - range[0],
    show,
    /** @param {Partial<Marks>} next */
    mark(next) {
      marks = { ...marks, ...next };
      later();
      redrawn();
    },
  };
}
