// The bar below the scene: pause, reset, ROS time and wall time.

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { rosNow, wallNow, watchTime } from "webviz/clock.js";
import { el, set, setText } from "webviz/dom.js";
import { icon, iconButton } from "webviz/icons.js";
import { recall, remember } from "webviz/remember.js";
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

/**
 * Fills the footer.
 *
 * @param {HTMLElement} place
 */
export function build(place) {
  let isPaused = false;
  let inSeconds = recall("time-in-seconds", false);
  /** @type {ValuesOf<"clock"> | null} */
  let shown = null;

  const pause = el("button", {
    type: "button",
    class: "wv-icon",
    onclick: toggle,
  });
  const reset = iconButton("reset", "Reset", () => act("Reset"), { tip: RESET_HINT });
  const ros = el("button", { type: "button", class: "wv-ros-time", onclick: swap });
  const badge = el("span", { class: "wv-badge" });
  const elapsed = part("Elapsed", "ROS time since the viewer started or was reset");
  const wall = part("Wall", "Wall time of the machine that webviz runs on");
  const wallElapsed = part("Wall elapsed", "Wall time since the viewer started or was reset");
  const track = el("div", { class: "wv-track-row" });
  const buttons = el("div", { class: "wv-transport-place" });
  place.append(
    track,
    needs("Pause", pause),
    needs("Reset", reset),
    buttons,
    ros,
    badge,
    elapsed.element,
    el("div", { class: "wv-space" }),
    ...buttonsOfFeatures,
    wall.element,
    wallElapsed.element,
  );
  const [recording = NO_TIMELINE] = timelines.map((make) => make({ track, buttons, toggle }));
  place.setAttribute("aria-label", "Time");

  function toggle() {
    return act("Pause", { paused: !isPaused });
  }

  function swap() {
    inSeconds = !inSeconds;
    remember("time-in-seconds", inSeconds);
    if (shown) show(shown);
  }

  /** @param {ValuesOf<"clock">} clock */
  function show(clock) {
    shown = clock;
    showPause(clock.get("is_paused"));
    const isKnown = clock.get("is_known");
    const isSimulated = clock.get("is_simulated");
    const now = rosNow(clock);
    const isRunning = clock.get("pace")[2] !== 0;
    const format = inSeconds
      ? (/** @type {number} */ time) => time.toFixed(isRunning ? 1 : 3)
      : timeOfDay;
    setText(ros, isKnown ? format(now, !isRunning) : "No time yet");
    set(ros, { "data-tip": hintOf(isKnown, isSimulated, inSeconds) });
    const past = recording.isPast() ? "past" : "bag";
    setText(badge, recording.isThere() ? past : badgeOf(isSimulated, clock.get("hz")));
    set(badge, { "data-tip": recording.names() ?? null });
    set(badge, { "data-simulated": isSimulated });
    const [beganRos, beganWall] = clock.get("began");
    // A recording has its own position; there the wall's time means nothing.
    elapsed.show(isKnown && !recording.isThere() ? duration(now - beganRos) : "");
    // Of a viewer without simulated time both are the same; while paused nothing may tick.
    const hasWall = isSimulated && !isPaused && !recording.isThere();
    wall.show(hasWall ? (inSeconds ? wallNow().toFixed(1) : timeOfDay(wallNow())) : "");
    wallElapsed.show(hasWall ? duration(wallNow() - beganWall) : "");
  }

  /** @param {boolean} paused */
  function showPause(paused) {
    isPaused = paused;
    const [name, tip] = recording.isThere()
      ? [
          paused ? "Play" : "Pause",
          `${paused ? "Play" : "Pause"} the ${recording.isPast() ? "past" : "recording"} in all browsers (Space)`,
        ]
      : [nameOf(paused), `${nameOf(paused)} the scene in all browsers; messages wait meanwhile`];
    if (pause.ariaLabel === name) return;
    const isPressed = recording.isThere() ? null : String(paused);
    set(pause, { "aria-label": name, "aria-pressed": isPressed, "data-tip": tip });
    pause.replaceChildren(icon(paused ? "play" : "pause"));
    place.classList.toggle("wv-paused", paused && !recording.isThere());
  }

  showPause(false);
  command({ name: "Reset", icon: "reset", key: "r", group: "Time", run: () => act("Reset") });
  provide(() =>
    recording.isThere()
      ? []
      : [{ name: nameOf(isPaused), icon: isPaused ? "play" : "pause", group: "Time", run: toggle }],
  );
  return watchTime(TICK_MS, show);
}

/** @param {boolean} isPaused */
const nameOf = (isPaused) => (isPaused ? "Resume" : "Pause");

/**
 * A label and a time, hidden while there is none.
 *
 * @param {string} label
 * @param {string} title
 */
function part(label, title) {
  const time = el("span", { class: "wv-number" });
  const element = el(
    "span",
    { class: "wv-time-part", title, hidden: true },
    el("span", { class: "wv-quiet" }, label),
    time,
  );
  /** @param {string} text */
  const show = (text) => {
    setText(time, text);
    set(element, { hidden: text === "" });
  };
  return { element, show };
}

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
