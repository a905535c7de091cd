// The track of the timeline: a slider over the whole recording that is zoomed by the wheel.

import { el } from "webviz/dom.js";
import { computed, effect, signal, untracked } from "webviz/signals.js";
import { duration } from "webviz/time_text.js";
import { oncePerFrame } from "webviz/timing.js";
import { draw } from "webviz/features/playback/draw.js";
import { listenToTrack } from "webviz/features/playback/gestures.js";
import { beforeText } from "webviz/moment.js";
import { boundsOf, following, isSame, rebounded } from "webviz/features/playback/range.js";

/** @import {Readable} from "webviz/signals.js" */
/** @import {Moment, Range} from "webviz/types.js" */
/** @import {Marks, TrackState} from "webviz/features/playback/gestures.js" */
/** @import {Seeks} from "webviz/features/playback/rewound.js" */

/**
 * Returns `{element, range(), length()}`; the window `range` is read in effects.
 *
 * @param {Seeks} seek
 * @param {Readable<Moment>} recording empty for none
 * @param {Readable<Marks>} marks
 */
export function track(seek, recording, marks) {
  const bounds = signal(/** @type {Range} */ ([0, 1])); // of the whole track, in seconds
  const range = signal(bounds.value); // the window
  const isBag = () => recording.value.get("is_live") === null;
  const position = () => seek.wanted() ?? recording.value.get("position") ?? 0;
  /** @type {TrackState} */
  const state = {
    isThere: () => recording.value.size > 0,
    range,
    bounds: () => bounds.value,
    first: () => recording.value.get("first"),
    marks: () => marks.value,
    // Live topics are counted back from now.
    textOf: (time, digits) =>
      isBag() ? duration(time, digits) : beforeText(time - recording.value.get("duration"), digits),
  };
  const canvas = el("canvas", {
    class: "wv-track",
    role: "slider",
    tabindex: 0,
    "aria-label": "Time of the recording",
    "aria-description": "Click or drag to seek, Shift+drag to select what is played, wheel to zoom",
    "aria-valuemin": () => bounds.value[0],
    "aria-valuemax": () => bounds.value[1],
    "aria-valuenow": position,
    "aria-valuetext": () => (state.isThere() ? state.textOf(position(), 1) : null),
  });
  const gestures = listenToTrack(canvas, seek, state);

  // The window stays within the recording, and goes on with what is played.
  effect(() => {
    const moment = recording.value;
    if (!state.isThere()) return;
    const [at, isDragged, window] = [position(), gestures.drag(), untracked(() => range.value)];
    const before = untracked(() => bounds.value);
    const now = boundsOf(moment);
    const kept = rebounded(window, before, now, isBag());
    const next = moment.get("is_playing") && !isDragged ? following(kept, at, now) : kept;
    bounds.value = now;
    if (!isSame(next, window)) range.value = next;
  });

  const picture = computed(() => {
    const [drag, moment] = [gestures.drag(), recording.value];
    const [first, now, gap] = ["first", "duration", "gap"].map((key) => moment.get(key));
    return {
      ...marks.value,
      range: range.value,
      selected: drag?.isSpan ? drag.span : moment.get("selected"),
      past: isBag() ? null : { first, now, gap },
      position: position(),
      hover: gestures.hover(),
    };
  });
  const redraw = oncePerFrame(() => {
    if (state.isThere() && canvas.clientWidth) draw(canvas, picture.value);
  });
  effect(() => {
    if (picture.value) redraw();
  });
  new ResizeObserver(redraw).observe(canvas);

  return {
    element: el("div", { class: "wv-track-place" }, canvas, gestures.label),
    range: () => range.value,
    length: () => range.value[1] - range.value[0],
  };
}
