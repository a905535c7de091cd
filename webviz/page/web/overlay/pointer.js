// Place of the mouse or a resting finger on the ground, and what it points at; until then, what the
// buttons of the mouse do.

import { act } from "webviz/act.js";
import { listenToLongPresses } from "webviz/controls/long_press.js";
import { el } from "webviz/dom.js";
import { recall, remember } from "webviz/remember.js";
import { groundAt, toFixedFrame } from "webviz/scene/ground.js";
import { hit } from "webviz/scene/mouse.js";
import * as views from "webviz/scene/view.js";
import { effect, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { oncePerFrame } from "webviz/timing.js";
import { sendable } from "webviz/tools/selection.js";
import * as viser from "webviz/viser_page.js";

/** @import {Vec2, Vec3} from "webviz/types.js" */

const REST_MS = 150;
const AGAIN_MS = 2000; // what is named may move on below a mouse that rests
const SHARE = 20; // at most one part of the time goes to looking again
const LOCKED = "Camera locked · Unlock it in the view's settings";
const LOOKS = "Left: look around · Middle or Shift: move · Right or wheel: walk · F: look at";
const TURNS = "Left: turn · Middle or Shift: move · Right or wheel: zoom · F: ";

/** Hints go once the user has moved the camera that often. */
const LEARNED = 5;

function hintOf() {
  if (views.options().lock_camera) return LOCKED;
  if (recall("camera-moves", 0) >= LEARNED) return "";
  if (views.isFPS()) return LOOKS;
  return TURNS + (views.type() === "TopDownOrtho" ? "centre" : "look at");
}

const displays = store("displays");
const settings = store("settings");

export function build() {
  const pointing = new Pointing();
  const events = viser.canvas().parentElement;
  events.addEventListener("pointerdown", learn);
  events.addEventListener("wheel", learn, { passive: true });
  events.addEventListener("pointermove", (event) => pointing.move(event));
  events.addEventListener("pointerleave", (event) => pointing.leave(event));
  events.addEventListener("pointerdown", (event) => pointing.leave(event));
  listenToLongPresses(events, (event) => pointing.press(event));
  views.onShow(() => pointing.hint());
  pointing.hint();
  // Names, and the frame of coordinates, are there before something is pointed at.
  effect(() => displays.all());
  effect(() => settings.get("fixed_frame"));
  const element = el("div", { class: "wv-card wv-pointer" }, pointing.text);
  effect(() => element.classList.toggle("wv-touched", pointing.isTouched.value));
  return element;
}

function learn() {
  const moves = recall("camera-moves", 0) + 1;
  if (moves <= LEARNED) remember("camera-moves", moves);
}

/** The thing that is pointed at, in words. */
class Pointing {
  text = signal("");
  isTouched = signal(false);
  /** @type {Vec2 | null} */
  #mouse = null;
  #resting = 0;
  #isNamed = false; // on a slow machine a frame comes after the mouse has rested
  #showGround = oncePerFrame(() => {
    if (this.#mouse && !this.#isNamed) this.#show(groundAt(...this.#mouse), "");
  });

  /** Shows what the buttons of the mouse do, unless something is pointed at. */
  hint() {
    if (!this.#mouse) this.text.value = hintOf();
  }

  /** @param {PointerEvent} event */
  move(event) {
    if (event.pointerType === "touch") return;
    this.#mouse = [event.clientX, event.clientY];
    clearTimeout(this.#resting);
    this.#isNamed = false;
    if (event.buttons === 0) this.#resting = setTimeout(() => this.#rest(), REST_MS);
    this.#showGround();
  }

  // A look at all that is drawn is too slow for each frame; and its display knows more.
  async #rest() {
    const begun = performance.now();
    const at = this.#mouse;
    const target = at && hit(at);
    if (!target || !("group" in target)) {
      // the ground
      if (this.#isNamed) this.#show(at && groundAt(...at), "");
      this.#isNamed = false;
      return;
    }
    const point = toFixedFrame(target.point);
    const pause = Math.max(AGAIN_MS, SHARE * (performance.now() - begun));
    this.#resting = setTimeout(() => this.#rest(), pause);
    if (!this.#isNamed) this.#show(point, nameOf(target));
    this.#isNamed = true;
    const [picks] = sendable([{ ...target, id: 0 }]);
    const { level, text } = await act("Identify", { picks }, { quiet: true, errors: "caller" });
    if (this.#isNamed && this.#mouse === at)
      this.#show(point, (level === "ok" && text) || nameOf(target));
  }

  /** @param {PointerEvent} event */
  press({ clientX, clientY }) {
    this.#mouse = [clientX, clientY];
    this.isTouched.value = true;
    this.#show(groundAt(clientX, clientY), "");
    this.#rest();
    return false;
  }

  /** @param {PointerEvent} event */
  leave({ type, pointerType }) {
    const isFinger = pointerType === "touch";
    if (isFinger !== (type === "pointerdown")) return; // what a finger pressed is read once it is lifted
    this.#mouse = null;
    this.isTouched.value = false;
    clearTimeout(this.#resting);
    this.hint();
  }

  /**
   * @param {Vec3 | null} point
   * @param {string} name
   */
  #show(point, name) {
    if (!point) {
      this.text.value = name;
      return;
    }
    const [x, y, z] = point.map((number) => number.toFixed(2));
    const height = Math.abs(point[2]) < 0.005 ? "" : ` z ${z}`;
    const frame = settings.get("fixed_frame");
    this.text.value = [`x ${x} y ${y}${height} m`, frame, name].filter(Boolean).join(" · ");
  }
}

/**
 * The display that drew something, and the frame that it moves with, if it has one of its own.
 *
 * @param {{group?: string}} hit
 */
function nameOf({ group }) {
  const [id, , ...rest] = (group ?? "").split("/");
  const part = rest.join("/").replace(/\|.*$/, "");
  return [displays.get(id)?.name ?? "", part].filter(Boolean).join(": ");
}
