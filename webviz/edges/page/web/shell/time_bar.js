// The bar below the scene: pause, reset, ROS time and wall time.

import { needs } from "../access.js";
import { act } from "../act.js";
import { rosNow, wallNow, watchTime } from "../clock.js";
import { el, set, setText } from "../dom.js";
import { icon } from "../icons.js";
import { recall, remember } from "../remember.js";
import { command, provide } from "./commands.js";
import { duration, timeOfDay } from "./time_text.js";

const TICK_MS = 100;
const RESET_HINT = "Reset: forget all transforms and messages (R)";

/** Fills the footer. The element `.wv-timeline` in its middle is for a recording. */
export function build(place) {
  let isPaused = false;
  let inSeconds = recall("time-in-seconds", false);
  let shown = null;

  const pause = el("button", {
    type: "button", class: "wv-icon", onclick: toggle,
  });
  const reset = el("button", {
    type: "button", class: "wv-icon", title: RESET_HINT, "aria-label": "Reset",
    onclick: () => act("Reset"),
  }, icon("reset"));
  const ros = el("button", { type: "button", class: "wv-ros-time", onclick: swap });
  const badge = el("span", { class: "wv-badge" });
  const elapsed = part("Elapsed", "ROS time since the viewer started or was reset");
  const wall = part("Wall", "Wall time of the machine that webviz runs on");
  const wallElapsed = part("Wall elapsed", "Wall time since the viewer started or was reset");
  place.append(
    needs("Pause", pause), needs("Reset", reset), ros, badge, elapsed.element, el("div", { class: "wv-timeline" }),
    wall.element, wallElapsed.element,
  );
  place.setAttribute("aria-label", "Time");

  function toggle() {
    return act("Pause", { paused: !isPaused });
  }

  function swap() {
    inSeconds = !inSeconds;
    remember("time-in-seconds", inSeconds);
    if (shown) show(shown);
  }

  function show(clock) {
    shown = clock;
    showPause(clock.get("is_paused"));
    const isKnown = clock.get("is_known");
    const isSimulated = clock.get("is_simulated");
    const now = rosNow(clock);
    const isRunning = clock.get("pace")[2] !== 0;
    const format = inSeconds ? (time) => time.toFixed(isRunning ? 1 : 3) : timeOfDay;
    setText(ros, isKnown ? format(now, !isRunning) : "No time yet");
    set(ros, { "data-tip": hintOf(isKnown, isSimulated, inSeconds) });
    setText(badge, badgeOf(isSimulated, clock.get("hz")));
    set(badge, { "data-simulated": isSimulated });
    const [beganRos, beganWall] = clock.get("began");
    elapsed.show(isKnown ? duration(now - beganRos) : "");
    // Of a viewer without simulated time both are the same; while paused nothing may tick.
    const hasWall = isSimulated && !isPaused;
    wall.show(hasWall ? (inSeconds ? wallNow().toFixed(1) : timeOfDay(wallNow())) : "");
    wallElapsed.show(hasWall ? duration(wallNow() - beganWall) : "");
  }

  function showPause(paused) {
    if (pause.firstChild && paused === isPaused) return;
    isPaused = paused;
    const name = paused ? "Resume" : "Pause";
    set(pause, {
      "aria-label": name, "aria-pressed": String(paused),
      "data-tip": `${name} the scene in all browsers; messages wait meanwhile`,
    });
    pause.replaceChildren(icon(paused ? "play" : "pause"));
    place.classList.toggle("wv-paused", paused);
  }

  showPause(false);
  command({ name: "Reset", icon: "reset", key: "r", group: "Time", run: () => act("Reset") });
  provide(() => [
    { name: isPaused ? "Resume" : "Pause", icon: isPaused ? "play" : "pause", group: "Time", run: toggle },
  ]);
  return watchTime(TICK_MS, show);
}

/** A label and a time, hidden while there is none. */
function part(label, title) {
  const time = el("span", { class: "wv-number" });
  const element = el("span", { class: "wv-time-part", title, hidden: true },
    el("span", { class: "wv-quiet" }, label), time);
  const show = (text) => {
    setText(time, text);
    set(element, { hidden: text === "" });
  };
  return { element, show };
}

function hintOf(isKnown, isSimulated, inSeconds) {
  if (!isKnown) return "Waiting for the first message on /clock";
  const kind = isSimulated ? "ROS time, from /clock or a recording" : "ROS time, which is wall time";
  return `${kind}. Click for ${inSeconds ? "date and time of day" : "seconds"}.`;
}

function badgeOf(isSimulated, hz) {
  if (!isSimulated) return "wall time";
  return hz ? `sim time · ${hz} Hz` : "sim time";
}
