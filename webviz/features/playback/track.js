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
  const position = () => seek.target() ?? recording.value.get("position") ?? 0;
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
  const canvas = slider(state, position);
  const gestures = listenToTrack(canvas, seek, state);

  const isPlaying = () => recording.value.get("is_playing") && !gestures.drag();
  effect(() => {
    if (!state.isThere()) return;
    const [now, followed] = [boundsOf(recording.value), isPlaying() ? position() : null];
    untracked(() => {
      const current = rebounded(range.value, bounds.value, now, isBag());
      const next = followed === null ? current : following(current, followed, now);
      bounds.value = now;
      if (!isSame(next, range.value)) range.value = next;
    });
  });

  const picture = computed(() => {
    const drag = gestures.drag();
    return {
      ...marks.value,
      range: range.value,
      selected: drag?.isSpan ? drag.span : recording.value.get("selected"),
      past: isBag() ? null : pastOf(recording.value),
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

/**
 * @param {TrackState} track
 * @param {() => number} position
 */
const slider = (track, position) =>
  el("canvas", {
    class: "wv-track",
    role: "slider",
    tabindex: 0,
    "aria-label": "Time of the recording",
    "aria-description": "Click or drag to seek, Shift+drag to select what is played, wheel to zoom",
    "aria-valuemin": () => track.bounds()[0],
    "aria-valuemax": () => track.bounds()[1],
    "aria-valuenow": position,
    "aria-valuetext": () => (track.isThere() ? track.textOf(position(), 1) : null),
  });

/**
 * What is remembered of live topics.
 *
 * @param {Moment} recording
 */
const pastOf = (recording) => ({
  first: recording.get("first"),
  now: recording.get("duration"),
  gap: recording.get("gap"),
});
