// Gestures of the pointer on handles while the tool Interact is active.

import { why } from "webviz/access.js";
import * as act from "webviz/act.js";
import * as channel from "webviz/channel.js";
import { takeKeysFirst } from "webviz/keys.js";
import { showHint, showLiveHint } from "webviz/tools/hint.js";
import { canvas, eachFrame, requestRender } from "webviz/viser_page.js";
import * as aids from "webviz/features/handles/aids.js";
import {
  CLICK_PX,
  grab,
  moveTo,
  pointAt,
  release,
  send,
  sendTo,
} from "webviz/features/handles/dragging.js";
import { setKeys, step, wheel } from "webviz/features/handles/dragging.js";
import * as glow from "webviz/features/handles/glow.js";
import { heldText, helpOf } from "webviz/features/handles/help.js";
import * as registry from "webviz/features/handles/registry.js";
import * as menu from "webviz/features/handles/menu.js";
import * as poses from "webviz/features/handles/poses.js";

/** @import {Drag, Place} from "webviz/features/handles/dragging.js" */
/** @import {Part} from "webviz/features/handles/registry.js" */
/** @import {SceneEvent, Vec2, Vec3} from "webviz/types.js" */

/** @typedef {Part & {at: Vec2, pointer: number, isResting?: boolean}} PendingPress */

const HOLD_MS = 500; // after which the server is told that the drag goes on
const LONG_MS = 600; // that a finger rests for the menu
const VIBRATE_MS = 15;
const BEFORE_PLACING = -1001;
const KEEP_OPEN = { once: true, passive: false };

/** The gestures of one page, from when this is made. */
export class HandleGestures {
  /** @type {Part | null} */
  #over = null; // what the pointer is on
  /** @type {Drag | null} */
  #drag = null;
  /** @type {PendingPress | null} */
  #pendingPress = null; // a press of the right button, or of a finger that may rest
  /** @type {{hover: Vec2, target: EventTarget | null} | null} */
  #moved = null; // where the pointer went since the last frame
  #lastText = "";

  constructor() {
    aids.install();
    eachFrame(BEFORE_PLACING, () => this.#follow());
    registry.onChange(() => this.#noteHolder());
    act.onAnswer("DragHandle", ({ number, text }) => {
      showHint("warn", text);
      if (this.#drag && number >= this.#drag.first) this.#end(this.#drag);
    });
    channel.onOpen(() => this.#drag && this.#end(this.#drag));
    takeKeysFirst((event) => {
      if (!this.#drag) return false;
      if (event.key === "Escape") this.#release(this.#drag);
      else setKeys(this.#drag, event);
      return event.key === "Escape";
    });
    window.addEventListener("keyup", (event) => this.#drag && setKeys(this.#drag, event), true);
  }

  /** Ends what goes on. */
  leave() {
    if (this.#drag) this.#release(this.#drag);
    this.#point(null);
  }

  /**
   * Takes an event of the pointer over the scene; whether it is none of the camera.
   *
   * @param {SceneEvent} event
   * @returns {boolean}
   */
  pointer(event) {
    const drag = this.#drag;
    if (!registry.all().size) return false;
    if ("deltaY" in event) return drag !== null && wheel(drag, event);
    const { type, pointerId, button, clientX, clientY } = event;
    if (drag) {
      if (pointerId !== drag.pointer) return true;
      if (type === "pointermove") moveTo(drag, event);
      else if (type === "pointercancel" || (type === "pointerup" && button === drag.button))
        this.#release(drag);
      return true;
    }
    if (this.#pendingPress && type !== "pointerdown")
      return this.#followPendingPress(this.#pendingPress, event);
    if (type === "pointermove") {
      if (event.buttons === 0) this.#moved = { hover: [clientX, clientY], target: event.target };
      return false;
    }
    if (type !== "pointerdown") return false;
    const part = registry.controlAt([clientX, clientY]);
    if (!part || ![0, 2].includes(button)) return false;
    event.preventDefault();
    if (button === 2) {
      this.#pendingPress = { ...part, pointer: pointerId, at: [clientX, clientY] };
      return true;
    }
    return this.#press(part, event);
  }

  /**
   * @param {Place} part
   * @param {PointerEvent} event
   */
  #press(part, event) {
    const handle = registry.all().get(part.id);
    if (!handle || !registry.controlOf(part)) return false;
    const refusal = why("DragHandle") || handle.refusal || heldText(handle);
    if (refusal) {
      showHint("warn", refusal);
      return true;
    }
    this.#drag = grab(part, event);
    if (!this.#drag) return false;
    canvas().setPointerCapture(event.pointerId);
    glow.light(part, "pressed");
    glow.dim(part.id);
    return true;
  }

  // The server says who holds a handle: it may be taken from this page.
  #noteHolder() {
    const drag = this.#drag;
    const handle = drag && registry.all().get(drag.id);
    if (!drag) return;
    const isMine = handle?.holder === window.webviz.browser;
    if (!handle || (drag.wasMine && !isMine)) this.#end(drag);
    else drag.wasMine ||= isMine;
  }

  // Once a frame, however many events there were.
  #follow() {
    const drag = this.#drag;
    if (this.#moved && !drag) {
      const { hover, target } = this.#moved;
      this.#point(target === canvas() ? registry.controlAt(hover) : null);
    }
    this.#moved = null;
    if (!drag) return;
    const { at, before } = drag;
    const isNews = at[0] !== before[0] || at[1] !== before[1] || drag.wheel;
    if (isNews) step(drag);
    const now = performance.now();
    const isResting = drag.isTouch && !drag.isMoved && now - drag.began > LONG_MS;
    if (isResting && registry.all().get(drag.id)?.menu.length) return this.#rest(drag);
    if (now - drag.sentAt > HOLD_MS) send(drag, "hold");
    requestRender();
  }

  /** @param {Drag} drag */
  #release(drag) {
    const { id, control, at } = drag;
    const point = release(drag);
    this.#end(drag);
    if (registry.controlOf({ id, control })?.mode === "menu") openMenu({ id, control, at, point });
  }

  /**
   * A finger that rests opens the menu, like the right button of a mouse: as it is lifted, for that
   * would close a menu which is open by then.
   *
   * @param {Drag} drag
   */
  #rest(drag) {
    const { id, control, at, pointer } = drag;
    send(drag, "release");
    this.#end(drag);
    this.#pendingPress = { id, control, at, pointer, isResting: true };
    navigator.vibrate?.(VIBRATE_MS);
  }

  /**
   * The server's pose counts again, also if the drag was taken from this page.
   *
   * @param {Drag} ended
   */
  #end({ id, pointer }) {
    if (canvas().hasPointerCapture(pointer)) canvas().releasePointerCapture(pointer);
    this.#drag = null;
    aids.show(null);
    glow.dim(null);
    glow.light(this.#over, "over");
    poses.letGo(id);
  }

  /**
   * @param {PendingPress} part
   * @param {PointerEvent} event
   */
  #followPendingPress(part, event) {
    if (event.pointerId !== part.pointer) return true;
    const { at } = part;
    const isFar = Math.hypot(event.clientX - at[0], event.clientY - at[1]) > CLICK_PX;
    if (event.type === "pointerup" && (event.button === 2 || part.isResting)) {
      this.#pendingPress = null;
      if (part.isResting) canvas().addEventListener("touchend", keepOpen, KEEP_OPEN);
      if (!isFar) openMenu({ ...part, point: pointAt(at, part.id) });
    } else if (event.type === "pointercancel") this.#pendingPress = null;
    return true;
  }

  /** @param {Place | null} part */
  #point(part) {
    this.#over = part;
    glow.light(part, "over");
    canvas().style.cursor = part ? "pointer" : "";
    const words = part ? wordsOf(part) : "";
    if (words !== this.#lastText) showLiveHint((this.#lastText = words));
  }
}

/**
 * No click follows the finger, which would close the menu.
 *
 * @param {TouchEvent} event
 */
const keepOpen = (event) => event.preventDefault();

/** @param {Part & {at: Vec2, point: Vec3 | null}} asked */
function openMenu({ id, control, at, point }) {
  const handle = registry.all().get(id);
  if (!handle?.menu.length) return;
  // Not before the event of the pointer has ended, which closes menus elsewhere.
  const choose = (/** @type {number} */ entry) =>
    sendTo({ id, control }, "choose", { entry, point });
  setTimeout(() => menu.open(at, handle, choose));
}

/** @param {Part} part */
function wordsOf(part) {
  const handle = registry.all().get(part.id);
  const control = registry.controlOf(part);
  return handle && control ? helpOf(handle, control, why("DragHandle")) : "";
}
