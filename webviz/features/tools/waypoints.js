// Collects poses of a tool that takes several, and sends them together.

import { el, set, setChildren, setText } from "webviz/dom.js";
import { icon, iconButton, textButton } from "webviz/icons.js";
import { watch } from "webviz/stores.js";
import { tell } from "webviz/tools/hint.js";
import * as history from "webviz/features/tools/history.js";
import { makePoses } from "webviz/tools/poses.js";
import * as registry from "webviz/tools/registry.js";

/** @import {MadeGesture, ToolFacts, Vec3} from "webviz/types.js" */

const MAX_POSES = 100;

const show = makePoses("waypoints");
/** @type {ToolFacts | null} */
let tool = null; // whose poses these are
/** @type {{point: Vec3, yaw: number}[]} */
let poses = [];
let isCollecting = false;
/** @type {string | null} */
let frame = null;
let update = () => {};

/**
 * True if a gesture of a tool is collected: Shift begins that.
 *
 * @param {ToolFacts} of
 * @param {boolean} isShifted
 */
export const collects = (of, isShifted) =>
  Boolean(of.several?.length) && (isCollecting || isShifted);

/**
 * Takes a finished gesture as a waypoint; whether it did.
 *
 * @param {ToolFacts} of
 * @param {MadeGesture} made
 */
export function collect(of, { points, yaw, keys }) {
  if (!collects(of, keys.includes("shift"))) return false;
  if (poses.length >= MAX_POSES) {
    tell("warn", `There are ${MAX_POSES} waypoints. Send them before you add others.`);
    return true;
  }
  if (tool?.id !== of.id) poses = [];
  tool = of;
  isCollecting = true;
  put([...poses, { point: points[0], yaw }]);
  return true;
}

/** The card with what can be done with the waypoints. */
export function install() {
  const mode = el(
    "button",
    {
      type: "button",
      class: "wv-button wv-waypoint-mode",
      onclick: toggle,
      "data-tip": "Collect poses and send them together",
    },
    icon("path"),
    el("span", {}, "Waypoints"),
  );
  const count = el("span", { class: "wv-quiet" });
  const back = iconButton("arrow-back", "Remove the last waypoint", () => put(poses.slice(0, -1)));
  const clear = iconButton("trash", "Remove all waypoints", () => put([]));
  const sends = el("div", { class: "wv-waypoint-sends" });
  const head = el("div", { class: "wv-waypoint-head" }, mode, count, back, clear);
  const card = el(
    "div",
    {
      class: "wv-card wv-waypoints",
      role: "group",
      "aria-label": "Waypoints",
      hidden: true,
    },
    head,
    sends,
  );
  /** @type {Map<string, HTMLButtonElement>} */
  const buttons = new Map();

  update = () => {
    const active = registry.active();
    const several = (poses.length ? tool : active)?.several ?? [];
    const isHidden = !several.length;
    if (card.hidden !== isHidden) card.hidden = isHidden;
    set(mode, { "aria-pressed": String(isCollecting) });
    const none = isCollecting ? "Drag on the ground for each." : "";
    setText(count, poses.length ? String(poses.length) : none);
    for (const part of [back, clear, sends]) {
      if (part.hidden !== !poses.length) part.hidden = !poses.length;
    }
    setChildren(
      sends,
      several.map((label) => {
        const button = buttons.get(label) ?? sendButton(label);
        buttons.set(label, button);
        return button;
      }),
    );
  };
  registry.onChange(update);
  // Numbers of another frame would be elsewhere.
  watch("settings", (settings) => {
    const now = settings.get("fixed_frame");
    if (frame !== null && now !== frame && poses.length) {
      put([]);
      tell("warn", "Removed the waypoints: the fixed frame has changed.");
    }
    frame = now;
  });
  return card;
}

/** @param {string} label */
const sendButton = (label) =>
  textButton(label, () => send(label), { class: "wv-button wv-primary" });

function toggle() {
  isCollecting = !isCollecting;
  put(isCollecting ? poses : []);
}

/** @param {string} several */
function send(several) {
  const sent = poses;
  isCollecting = false;
  put([]);
  if (!tool) return;
  if (registry.active()?.id === tool.id && !tool.stays) registry.select(null);
  history.send(tool, {
    points: sent.map(({ point }) => point),
    yaws: sent.map(({ yaw }) => yaw),
    yaw: sent[0].yaw,
    keys: [],
    several,
  });
}

/** @param {{point: Vec3, yaw: number}[]} wanted */
function put(wanted) {
  poses = wanted;
  show(poses.map((pose, index) => ({ ...pose, number: String(index + 1) })));
  update();
}
