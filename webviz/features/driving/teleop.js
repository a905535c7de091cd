// The tool that drives. What is held on this page goes to the server with every heartbeat; the
// server ramps it, publishes it, and stops the robot when heartbeats stay away or acknowledge nothing
// new. Hence heartbeats come from here and not from a worker: a page that hangs does not learn what
// is let go.

import * as channel from "webviz/channel.js";
import { isTyping, takeKeys } from "webviz/commands.js";
import { shortcuts } from "webviz/keys.js";
import { places } from "webviz/shell/shell.js";
import { owned, root, signal } from "webviz/signals.js";
import { every } from "webviz/timing.js";
import { gesture } from "webviz/tools/gestures.js";
import * as registry from "webviz/tools/registry.js";
import { added, makeCard } from "webviz/features/driving/teleop_card.js";
import { makeGamepad } from "webviz/features/driving/teleop_gamepad.js";
import * as keys from "webviz/features/driving/teleop_keys.js";

/** @import {DrivingReport} from "webviz/messages.js" */
/** @import {Shares} from "webviz/features/driving/teleop_keys.js" */
/** @import {GestureParts, ViewerTool} from "webviz/types.js" */

/**
 * @typedef {{
 *   id: string, card: ReturnType<typeof makeCard>, gamepad: ReturnType<typeof makeGamepad>,
 *   beat: number, beats: number, sentAt: number, heardAt: number, input: Shares, driver: number | null,
 *   end: () => void,
 * }} Driven
 */

const BEAT_MS = 50; // while something is held; the server stops the robot after 200 ms without
const IDLE_BEATS = 2; // one heartbeat in so many while nothing is held
const GAP_MS = 15; // between two that something changes
const SILENCE_MS = 200; // of the server, after which heartbeats move nothing
/** @type {Shares} */
const STILL = [0, 0, 0];
const HINT = matchMedia("(pointer: coarse)").matches
  ? "Drag the stick."
  : "Hold W A S D, the arrow keys, or the stick. Esc leaves.";

const open = signal(/** @type {Driven | null} */ (null)); // while a tool that drives is active
const isHere = signal(true);

/**
 * The gesture of a tool that drives.
 *
 * @param {ViewerTool} tool
 * @returns {GestureParts & {icon: string}}
 */
const tool = ({ icon, gesture }) => ({
  icon: icon === gesture ? "wheel" : icon,
  hint: HINT,
  leave: release,
});

export function install() {
  shortcuts("While driving", [
    { does: "Drive", keys: ["w", "a", "s", "d"] },
    { does: "Drive with one hand", keys: ["ArrowUp", "ArrowLeft", "ArrowDown", "ArrowRight"] },
    { does: "Sideways", keys: ["q", "e"] },
  ]);
  gesture("drive", tool);
  registry.onChange(follow);
  takeKeys((/** @type {KeyboardEvent} */ event) => {
    const driven = open.value;
    if (!driven || document.querySelector("dialog[open]")) return false;
    const isTaken = keys.press(event, driven.card.canGoSideways());
    update();
    return isTaken;
  });
  window.addEventListener("keyup", (event) => keys.lift(event) && update(), true);
  window.addEventListener("blur", () => away());
  window.addEventListener("focus", () => (isHere.value = true));
  window.addEventListener("pointerdown", () => (isHere.value = true), true);
  window.addEventListener("pagehide", () => away());
  document.addEventListener("visibilitychange", () => document.hidden && away());
  document.addEventListener("focusin", (event) => {
    if (isTyping(event) || /** @type {Element} */ (event.target).closest("dialog")) release();
  });
  channel.on("DrivingReport", readReport);
  channel.onOpen(() => {
    if (open.value) open.value.beat = 0;
    release();
  });
}

/** The robot that is driven, and by whom; null while no tool that drives is active. */
export const state = () => open.value;

// The card is there while the tool is active, however it became so.
function follow() {
  const active = registry.active();
  const id = active?.gesture === "drive" ? active.id : null;
  if (id === (open.value?.id ?? null)) return;
  end();
  if (id !== null) begin(id);
}

/** @param {string} id */
function begin(id) {
  root((end) => {
    const card = makeCard(id, update);
    places.legend.append(card.element);
    owned(() => card.element.remove());
    every(BEAT_MS, tick);
    open.value = {
      id,
      card,
      end,
      gamepad: makeGamepad(),
      beat: 0,
      beats: 0,
      sentAt: 0,
      heardAt: performance.now(),
      input: STILL,
      driver: null,
    };
    card.focus();
  });
  send();
}

function end() {
  release();
  open.value?.end();
  open.value = null;
}

function away() {
  isHere.value = false;
  open.value?.gamepad.disarm();
  release();
}

// Everything is let go, whatever fingers do.
function release() {
  keys.release();
  open.value?.card.release();
  update();
}

function tick() {
  update();
  const driven = open.value;
  if (!driven) return;
  driven.beats += 1;
  const isHeld = driven.input !== STILL;
  if (isHeld ? performance.now() - driven.sentAt >= GAP_MS : driven.beats % IDLE_BEATS === 0)
    send();
  const isLate = isHeld && performance.now() - driven.heardAt > SILENCE_MS;
  if (isLate) driven.card.showNote("The connection to webviz is too slow to drive.", true);
}

/** Takes up what is held now, and sends it if that is something else. */
function update() {
  const driven = open.value;
  if (!driven) return;
  const sticks = isHere.value ? driven.gamepad.share() : STILL;
  const shares = [keys.share(), driven.card.share(), sticks];
  const sums = shares.reduce(added);
  const input = sums.map((part) => Math.max(-1, Math.min(1, part)));
  const isStill = input.every((part) => part === 0);
  const { input: before } = driven;
  const isSame = input.every((part, axis) => part === before[axis]);
  driven.input = isStill ? STILL : input;
  driven.card.showHeld(input);
  // Moves of a finger may wait for the next heartbeat; letting go may not.
  if (!isSame && (isStill || performance.now() - driven.sentAt >= GAP_MS)) send();
}

function send() {
  const driven = open.value;
  if (!driven || !channel.isOpen() || document.hidden) return;
  const { id, beat, input } = driven;
  const [linear, lateral, angular] = input;
  driven.sentAt = performance.now();
  channel.send({ type: "Drive", tool: id, beat, linear, lateral, angular });
}

/** @param {DrivingReport} report */
function readReport({ tool: id, beat, driver, problem }) {
  const driven = open.value;
  if (id !== driven?.id) return;
  driven.heardAt = performance.now();
  Object.assign(driven, { beat, driver });
  const isOthers = driver !== null && driver !== window.webviz.browser;
  const others = `Browser ${driver} is driving. You can drive once it has let go for a second.`;
  driven.card.showNote(isOthers ? others : problem, isOthers || problem !== "");
}
