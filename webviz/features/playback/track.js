// The track of the timeline: a slider over the whole recording that is zoomed by the wheel.

import { el, set } from "webviz/dom.js";
import { duration } from "webviz/time_text.js";
import { draw } from "webviz/features/playback/draw.js";
import { listenToTrack } from "webviz/features/playback/gestures.js";
import { beforeText } from "webviz/moment.js";
import { boundsOf, following, isSame, rebounded } from "webviz/features/playback/range.js";

/** @import {Moment, Range} from "webviz/types.js" */
/** @import {Marks} from "webviz/features/playback/gestures.js" */
/** @import {Seeks} from "webviz/features/playback/rewound.js" */

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
  let frame = 0;

  const canvas = el("canvas", {
    class: "wv-track",
    role: "slider",
    tabindex: 0,
    "aria-label": "Time of the recording",
    "aria-description": "Click or drag to seek, Shift+drag to select what is played, wheel to zoom",
  });
  const gestures = listenToTrack(canvas, seek, {
    isThere: () => recording !== null,
    range: () => range,
    setRange,
    bounds: () => bounds,
    first: () => recording?.get("first"),
    marks: () => marks,
    textOf,
    redraw: later,
  });
  const element = el("div", { class: "wv-track-place" }, canvas, gestures.label);
  new ResizeObserver(later).observe(canvas);

  const position = () => seek.wanted() ?? recording?.get("position") ?? 0;
  const isBag = () => recording?.get("is_live") === null;

  // Live topics are counted back from now.
  /** @param {number} time @param {number} digits */
  function textOf(time, digits) {
    return isBag() ? duration(time, digits) : beforeText(time - recording?.get("duration"), digits);
  }

  /** @param {Moment} next */
  function show(next) {
    recording = next;
    const before = bounds;
    bounds = boundsOf(recording);
    let window = rebounded(range, before, bounds, isBag());
    if (recording.get("is_playing") && !gestures.drag())
      window = following(window, position(), bounds);
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
      const drag = gestures.drag();
      const [first, now, gap] = ["first", "duration", "gap"].map((key) => recording?.get(key));
      draw(canvas, {
        ...marks,
        range,
        selected: drag?.isSpan ? drag.span : recording.get("selected"),
        past: isBag() ? null : { first, now, gap },
        position: position(),
        hover: gestures.hover(),
      });
    });
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
