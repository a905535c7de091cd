// Collects poses of a tool that takes several, and sends them together.

import { el } from "webviz/dom.js";
import { icon, iconButton, textButton } from "webviz/icons.js";
import { batch, each, effect, signal } from "webviz/signals.js";
import { onFrameChange } from "webviz/tools/frame_change.js";
import { showHint } from "webviz/tools/hint.js";
import * as history from "webviz/features/tools/history.js";
import { makePoses } from "webviz/tools/poses.js";
import * as registry from "webviz/tools/registry.js";

/** @import {MadeGesture, ToolFacts, Vec3} from "webviz/types.js" */

const MAX_POSES = 100;

/** The tool whose poses these are. */
const tool = signal(/** @type {ToolFacts | null} */ (null));
const poses = signal(/** @type {{point: Vec3, yaw: number}[]} */ ([]));
const isCollecting = signal(false);

/**
 * True if a gesture of a tool is collected: Shift begins that.
 *
 * @param {ToolFacts} of
 * @param {boolean} isShifted
 */
export const collects = (of, isShifted) =>
  Boolean(of.several?.length) && (isCollecting.value || isShifted);

/**
 * Takes a finished gesture as a waypoint; whether it did.
 *
 * @param {ToolFacts} of
 * @param {MadeGesture} made
 */
export function collect(of, { points, yaw, keys }) {
  if (!collects(of, keys.includes("shift"))) return false;
  if (poses.value.length >= MAX_POSES) {
    showHint("warn", `There are ${MAX_POSES} waypoints. Send them before you add others.`);
    return true;
  }
  const before = tool.value?.id === of.id ? poses.value : [];
  batch(() => {
    tool.value = of;
    isCollecting.value = true;
    poses.value = [...before, { point: points[0], yaw }];
  });
  return true;
}

/** The card with what can be done with the waypoints. */
export function install() {
  const show = makePoses("waypoints");
  effect(() => show(poses.value.map((pose, index) => ({ ...pose, number: String(index + 1) }))));
  onFrameChange(() => {
    if (!poses.value.length) return;
    poses.value = [];
    showHint("warn", "Removed the waypoints: the fixed frame has changed.");
  });
  return card();
}

function card() {
  const several = () => (poses.value.length ? tool.value : registry.active())?.several ?? [];
  const hidden = () => !poses.value.length;
  const none = () => (isCollecting.value ? "Drag on the ground for each." : "");
  const mode = el(
    "button",
    {
      type: "button",
      class: "wv-button wv-waypoint-mode",
      "aria-pressed": () => String(isCollecting.value),
      onclick: toggle,
      "data-tip": "Collect poses and send them together",
    },
    icon("path"),
    el("span", {}, "Waypoints"),
  );
  const count = el("span", { class: "wv-quiet" }, () => String(poses.value.length || none()));
  const dropLast = () => (poses.value = poses.value.slice(0, -1));
  const back = iconButton("arrow-back", "Remove the last waypoint", dropLast, { hidden });
  const clear = iconButton("trash", "Remove all waypoints", () => (poses.value = []), { hidden });
  return el(
    "div",
    {
      class: "wv-card wv-waypoints",
      role: "group",
      "aria-label": "Waypoints",
      hidden: () => !several().length,
    },
    el("div", { class: "wv-waypoint-head" }, mode, count, back, clear),
    el("div", { class: "wv-waypoint-sends", hidden }, each(several, String, sendButton)),
  );
}

/**
 * @param {unknown} _
 * @param {string} label
 */
const sendButton = (_, label) =>
  textButton(label, () => send(label), { class: "wv-button wv-primary" });

function toggle() {
  isCollecting.value = !isCollecting.value;
  if (!isCollecting.value) poses.value = [];
}

/** @param {string} several */
function send(several) {
  const [route, of] = [poses.value, tool.value];
  isCollecting.value = false;
  poses.value = [];
  if (!of) return;
  if (registry.active()?.id === of.id && !of.stays) registry.select(null);
  history.send(of, {
    points: route.map(({ point }) => point),
    yaws: route.map(({ yaw }) => yaw),
    yaw: route[0].yaw,
    keys: [],
    several,
  });
}
