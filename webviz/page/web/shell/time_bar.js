// The bar below the scene: pause, reset, ROS time and wall time.

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { rosNow, wallNow } from "webviz/clock.js";
import { el } from "webviz/dom.js";
import { icon, iconButton } from "webviz/icons.js";
import { recall, remember } from "webviz/remember.js";
import { effect, signal, untracked } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { every } from "webviz/timing.js";
import { command, provide } from "webviz/commands.js";
import { duration, timeOfDay } from "webviz/time_text.js";

/** @import {ValuesOf} from "webviz/types.js" */

/**
 * The state of a timeline for the bar: whether a position is shown instead of what arrives, whether topics
 * are live, and the names of the recordings that are played, null for none.
 *
 * @typedef {{isThere(): boolean, isPast(): boolean, names(): string | null}} Timeline
 */
/**
 * Places for a track and for buttons, and a function that plays or pauses.
 *
 * @typedef {{track: Element, buttons: Element, toggle: () => unknown}} TimelinePlaces
 */

const TICK_MS = 100;
const RESET_HINT = "Reset: forget all transforms and messages (R)";

/** @type {Element[]} */
const buttonsOfFeatures = [];

/** Adds a button to the bar. @param {Element} button */
export const timeBarButton = (button) => buttonsOfFeatures.push(button);

/** @type {((places: TimelinePlaces) => Timeline)[]} */
const timelines = [];

/** Adds a timeline to the bar, made when the bar is. @param {(places: TimelinePlaces) => Timeline} make */
export const timeBarTimeline = (make) => timelines.push(make);

/** @type {Timeline} */
const NO_TIMELINE = { isThere: () => false, isPast: () => false, names: () => null };

const clock = store("clock");
const ticks = signal(0);

/**
 * Reads a value once per tick, however often it changes: the rate of a clock does with each frame.
 *
 * @template T
 * @param {() => T} read
 * @returns {T}
 */
function perTick(read) {
  void ticks.value;
  return untracked(read);
}

/**
 * Fills the footer.
 *
 * @param {HTMLElement} place
 */
export function build(place) {
  const isPaused = () => clock.get("is_paused") ?? false;
  const toggle = () => act("Pause", { paused: !isPaused() });
  const track = el("div", { class: "wv-track-row" });
  const buttons = el("div", { class: "wv-transport-place" });
  const [recording = NO_TIMELINE] = timelines.map((make) => make({ track, buttons, toggle }));
  const times = timesNow(recording);
  place.append(
    track,
    needs("Pause", pauseButton(recording, isPaused, toggle)),
    needs(
      "Reset",
      iconButton("reset", "Reset", () => act("Reset"), { tip: RESET_HINT }),
    ),
    buttons,
    times.ros,
    badge(recording),
    part("Elapsed", "ROS time since the viewer started or was reset", times.elapsed),
    el("div", { class: "wv-space" }),
    ...buttonsOfFeatures,
    part("Wall", "Wall time of the machine that webviz runs on", times.wall),
    part("Wall elapsed", "Wall time since the viewer started or was reset", times.wallElapsed),
  );
  place.setAttribute("aria-label", "Time");
  effect(() => place.classList.toggle("wv-paused", isPaused() && !recording.isThere()));
  command({ name: "Reset", icon: "reset", key: "r", group: "Time", run: () => act("Reset") });
  provide(() =>
    recording.isThere()
      ? []
      : [
          {
            name: nameOf(isPaused()),
            icon: isPaused() ? "play" : "pause",
            group: "Time",
            run: toggle,
          },
        ],
  );
}

/**
 * @param {Timeline} recording
 * @param {() => boolean} isPaused
 * @param {() => unknown} toggle
 */
function pauseButton(recording, isPaused, toggle) {
  const name = () => (recording.isThere() ? (isPaused() ? "Play" : "Pause") : nameOf(isPaused()));
  const tip = () =>
    recording.isThere()
      ? `${name()} the ${recording.isPast() ? "past" : "recording"} in all browsers (Space)`
      : `${name()} the scene in all browsers; messages wait meanwhile`;
  return el(
    "button",
    {
      type: "button",
      class: "wv-icon",
      "aria-label": name,
      "aria-pressed": () => (recording.isThere() ? null : String(isPaused())),
      "data-tip": tip,
      onclick: toggle,
    },
    () => icon(isPaused() ? "play" : "pause"),
  );
}

/** The origin of the time. @param {Timeline} recording */
const badge = (recording) =>
  el(
    "span",
    {
      class: "wv-badge",
      "data-tip": () => recording.names(),
      "data-simulated": () => clock.get("is_simulated"),
    },
    () => {
      if (!clock.isThere()) return "";
      if (recording.isThere()) return recording.isPast() ? "past" : "bag";
      const hz = perTick(() => clock.get("hz")) ?? 0;
      return badgeOf(clock.get("is_simulated") ?? false, hz);
    },
  );

/**
 * The button with the ROS time, and the other times as texts, "" for none; they are read in effects.
 *
 * @param {Timeline} recording
 */
function timesNow(recording) {
  const inSeconds = signal(recall("time-in-seconds", false));
  every(TICK_MS, () => document.hidden || (ticks.value += 1));
  /**
   * A text that goes on with time, "" until the clock is known.
   *
   * @param {(values: ValuesOf<"clock">) => string} read
   */
  const ticking = (read) => () => (clock.isThere() ? read(perTick(() => clock.all())) : "");
  // Of a viewer without simulated time both are the same; while paused nothing may tick.
  const hasWall = () =>
    clock.get("is_simulated") && !clock.get("is_paused") && !recording.isThere();
  const swap = () => {
    inSeconds.value = !inSeconds.value;
    remember("time-in-seconds", inSeconds.value);
  };
  const ros = ticking((values) => {
    if (!values.get("is_known")) return "No time yet";
    const isRunning = values.get("pace")[2] !== 0;
    const now = rosNow(values);
    return inSeconds.value ? now.toFixed(isRunning ? 1 : 3) : timeOfDay(now, !isRunning);
  });
  const tip = ticking((values) =>
    hintOf(values.get("is_known"), values.get("is_simulated"), inSeconds.value),
  );
  return {
    ros: el(
      "button",
      { type: "button", class: "wv-ros-time", "data-tip": tip, onclick: swap },
      ros,
    ),
    // A recording has its own position; there the wall's time means nothing.
    elapsed: ticking((values) =>
      values.get("is_known") && !recording.isThere()
        ? duration(rosNow(values) - values.get("began")[0])
        : "",
    ),
    wall: ticking(() => {
      if (!hasWall()) return "";
      return inSeconds.value ? wallNow().toFixed(1) : timeOfDay(wallNow());
    }),
    wallElapsed: ticking((values) =>
      hasWall() ? duration(wallNow() - values.get("began")[1]) : "",
    ),
  };
}

/** @param {boolean} isPaused */
const nameOf = (isPaused) => (isPaused ? "Resume" : "Pause");

/**
 * A label and a time, hidden while there is none.
 *
 * @param {string} label
 * @param {string} title
 * @param {() => string} time
 */
const part = (label, title, time) =>
  el(
    "span",
    { class: "wv-time-part", title, hidden: () => !time() },
    el("span", { class: "wv-quiet" }, label),
    el("span", { class: "wv-number" }, time),
  );

/**
 * @param {boolean} isKnown
 * @param {boolean} isSimulated
 * @param {boolean} inSeconds
 */
function hintOf(isKnown, isSimulated, inSeconds) {
  if (!isKnown) return "Waiting for the first message on /clock";
  const kind = isSimulated
    ? "ROS time, from /clock or a recording"
    : "ROS time, which is wall time";
  return `${kind}. Click for ${inSeconds ? "date and time of day" : "seconds"}.`;
}

/**
 * @param {boolean} isSimulated
 * @param {number} hz
 */
function badgeOf(isSimulated, hz) {
  if (!isSimulated) return "wall time";
  return hz ? `sim time · ${hz} Hz` : "sim time";
}
