// Place of the mouse or a resting finger on the ground, and what it points at; until then, what the
// buttons of the mouse do.

import { act } from "webviz/act.js";
import { listenToLongPresses } from "webviz/controls/long_press.js";
import { el, setText } from "webviz/dom.js";
import { recall, remember } from "webviz/remember.js";
import { groundAt, toFixedFrame } from "webviz/scene/ground.js";
import { hit } from "webviz/scene/mouse.js";
import * as views from "webviz/scene/view.js";
import { watch } from "webviz/stores.js";
import { sendable } from "webviz/tools/selection.js";
import * as viser from "webviz/viser_page.js";

/** @import {ValuesOf, Vec2, Vec3} from "webviz/types.js" */

const REST_MS = 150;
const AGAIN_MS = 2000; // what is named may move on below a mouse that rests
const SHARE = 20; // at most one part of the time goes to looking again
const LOCKED = "Camera locked · Unlock it in the view's settings";
const LOOKS = "Left: look around · Middle or Shift: move · Right or wheel: walk · F: look at";
const TURNS = "Left: turn · Middle or Shift: move · Right or wheel: zoom · F: ";

/** Hints go once somebody has moved the camera that often. */
const LEARNED = 5;

function hintOf() {
  if (views.options().lock_camera) return LOCKED;
  if (recall("camera-moves", 0) >= LEARNED) return "";
  if (views.isFPS()) return LOOKS;
  return TURNS + (views.type() === "TopDownOrtho" ? "centre" : "look at");
}

export function build() {
  const text = el("div", { class: "wv-card wv-pointer" });
  /** @type {ValuesOf<"displays"> | null} */
  let names = null;
  let frame = "";
  /** @type {Vec2 | null} */
  let mouse = null;
  let isWaiting = false;
  let resting = 0;
  let isNamed = false; // on a slow machine a frame comes after the mouse has rested
  watch("displays", (rows) => (names = rows));
  watch("settings", (settings) => (frame = settings.get("fixed_frame") ?? ""));

  const hint = () => setText(text, hintOf());

  /** @param {PointerEvent} event */
  function move(event) {
    if (event.pointerType === "touch") return;
    mouse = [event.clientX, event.clientY];
    clearTimeout(resting);
    isNamed = false;
    if (event.buttons === 0) resting = setTimeout(rest, REST_MS);
    if (isWaiting) return;
    isWaiting = true;
    requestAnimationFrame(() => {
      isWaiting = false;
      if (mouse && !isNamed) show(groundAt(...mouse), "");
    });
  }

  // A look at all that is drawn is too slow for each frame; and its display knows more.
  async function rest() {
    const begun = performance.now();
    const found = mouse && hit(mouse);
    if (!found || !("group" in found)) {
      // the ground
      if (isNamed) show(mouse && groundAt(...mouse), "");
      isNamed = false;
      return;
    }
    const [at, point] = [mouse, toFixedFrame(found.point)];
    resting = setTimeout(rest, Math.max(AGAIN_MS, SHARE * (performance.now() - begun)));
    if (!isNamed) show(point, nameOf(found, names));
    isNamed = true;
    const [picks] = sendable([{ ...found, id: 0 }]);
    const { level, text } = await act("Identify", { picks }, { quiet: true, errors: "caller" });
    if (isNamed && mouse === at) show(point, (level === "ok" && text) || nameOf(found, names));
  }

  /** @param {PointerEvent} event */
  function press({ clientX, clientY }) {
    mouse = [clientX, clientY];
    text.classList.add("wv-touched");
    show(groundAt(...mouse), "");
    rest();
    return false;
  }

  /** @param {PointerEvent} event */
  function leave({ type, pointerType }) {
    const isFinger = pointerType === "touch";
    if (isFinger !== (type === "pointerdown")) return; // what a finger pressed is read once it is lifted
    mouse = null;
    text.classList.remove("wv-touched");
    clearTimeout(resting);
    hint();
  }

  /**
   * @param {Vec3 | null} point
   * @param {string} name
   */
  function show(point, name) {
    if (!point) return setText(text, name);
    const [x, y, z] = point.map((number) => number.toFixed(2));
    const height = Math.abs(point[2]) < 0.005 ? "" : ` z ${z}`;
    setText(text, [`x ${x} y ${y}${height} m`, frame, name].filter(Boolean).join(" · "));
  }

  function learn() {
    const moves = recall("camera-moves", 0) + 1;
    if (moves <= LEARNED) remember("camera-moves", moves);
  }

  const events = viser.canvas().parentElement;
  events.addEventListener("pointerdown", learn);
  events.addEventListener("wheel", learn, { passive: true });
  events.addEventListener("pointermove", move);
  events.addEventListener("pointerleave", leave);
  events.addEventListener("pointerdown", leave);
  listenToLongPresses(events, press);
  views.onShow(() => mouse ?? hint());
  hint();
  return text;
}

// The display that drew something, and the frame that it moves with, if it has one of its own.
/**
 * @param {{group?: string}} hit
 * @param {ValuesOf<"displays"> | null} names
 */
function nameOf({ group }, names) {
  const [id, , ...rest] = (group ?? "").split("/");
  const part = rest.join("/").replace(/\|.*$/, "");
  return [names?.get(id)?.name ?? "", part].filter(Boolean).join(": ");
}
