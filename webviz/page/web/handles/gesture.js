// Gestures of the pointer on handles while the tool Interact is active.

import { why } from "webviz/access.js";
import * as act from "webviz/act.js";
import * as channel from "webviz/channel.js";
import { takeKeysFirst } from "webviz/keys.js";
import { pickAt } from "webviz/scene/picking/pick.js";
import { tell, tellLive } from "webviz/tools/hint.js";
import { canvas, eachFrame, requestRender } from "webviz/viser_page.js";
import * as aids from "webviz/handles/aids.js";
import { axisOf, begin } from "webviz/handles/drags.js";
import * as glow from "webviz/handles/glow.js";
import { heldText, helpOf } from "webviz/handles/help.js";
import * as known from "webviz/handles/known.js";
import * as menu from "webviz/handles/menu.js";
import * as poses from "webviz/handles/poses.js";
import { frameNode, projectionOf } from "webviz/scene/projection.js";

/** @import {Commands} from "webviz/messages.js" */
/** @import {Moved} from "webviz/handles/drags.js" */
/** @import {Part} from "webviz/handles/known.js" */
/** @import {Pose} from "webviz/vectors.js" */
/** @import {Vector3} from "three" */
/** @import {SceneEvent, Vec2, Vec3} from "webviz/types.js" */

/**
 * @typedef {Commands["DragHandle"]["drag"]} SentDrag
 * @typedef {Part & {point: Vector3}} Place
 * @typedef {Part & {at: Vec2, pointer: number, isResting?: boolean}} Asked
 * @typedef {Part & {
 *   pose: Pose, pointer: number, button: number, wasMine: boolean, at: Vec2, before: Vec2,
 *   wheel: number, shift: boolean, ctrl: boolean, isTouch: boolean, began: number, from: Vec2,
 *   isMoved: boolean, step: ReturnType<typeof begin>, now: Moved | null, sent: number, first: number,
 *   axis: Vec3 | null,
 * }} Drag
 */

const HOLD_MS = 500; // after which the server is told that the drag goes on
const LONG_MS = 600; // that a finger rests for the menu
const VIBRATE_MS = 15;
const CLICK_PX = 6;
const BEFORE_PLACING = -1001;
const KEEP_OPEN = { once: true, passive: false };

/** @type {Part | null} */
let over = null; // what the pointer is on
/** @type {Drag | null} */
let drag = null;
/** @type {Asked | null} */
let asked = null; // a press of the right button, or of a finger that may rest
/** @type {{hover: Vec2, target: EventTarget | null} | null} */
let moved = null; // where the pointer went since the last frame
let said = "";

export function install() {
  aids.install();
  eachFrame(BEFORE_PLACING, follow);
  known.onChange(() => {
    const handle = drag && known.all().get(drag.id);
    if (!drag) return;
    const isMine = handle?.holder === window.webviz.browser;
    if (!handle || (drag.wasMine && !isMine)) lose(drag);
    else drag.wasMine ||= isMine;
  });
  act.onAnswer("DragHandle", ({ number, text }) => {
    tell("warn", text);
    if (drag && number >= drag.first) lose(drag);
  });
  channel.onOpen(() => drag && lose(drag));
  takeKeysFirst((event) => {
    if (!drag) return false;
    if (event.key === "Escape") release(drag);
    else setKeys(drag, event);
    return event.key === "Escape";
  });
  window.addEventListener("keyup", (event) => drag && setKeys(drag, event), true);
}

/** Ends what goes on. */
export function leave() {
  if (drag) release(drag);
  point(null);
}

/**
 * Takes an event of the pointer over the scene; whether it is none of the camera.
 *
 * @param {SceneEvent} event
 * @returns {boolean}
 */
export function pointer(event) {
  if (!known.all().size) return false;
  if ("deltaY" in event) return drag !== null && wheel(drag, event);
  const { type, pointerId, button, clientX, clientY } = event;
  if (drag) {
    if (pointerId !== drag.pointer) return true;
    if (type === "pointermove") moveTo(drag, event);
    else if (type === "pointercancel" || (type === "pointerup" && button === drag.button))
      release(drag);
    return true;
  }
  if (asked && type !== "pointerdown") return followAsked(asked, event);
  if (type === "pointermove") {
    if (event.buttons === 0) moved = { hover: [clientX, clientY], target: event.target };
    return false;
  }
  if (type !== "pointerdown") return false;
  const part = known.controlAt([clientX, clientY]);
  if (!part || ![0, 2].includes(button)) return false;
  event.preventDefault();
  if (button === 2) {
    asked = { ...part, pointer: pointerId, at: [clientX, clientY] };
    return true;
  }
  return press(part, event);
}

/**
 * @param {Place} part
 * @param {PointerEvent} event
 */
function press(part, event) {
  const handle = known.all().get(part.id);
  const control = known.controlOf(part);
  if (!handle || !control) return false;
  const refusal = why("DragHandle") || handle.refusal || heldText(handle);
  if (refusal) {
    tell("warn", refusal);
    return true;
  }
  const pose = poses.poseOf(part.id);
  const node = frameNode(handle.frame);
  if (!pose || !node) return false;
  /** @type {Vec2} */
  const at = [event.clientX, event.clientY];
  const projection = projectionOf(node);
  const start = {
    control,
    pose,
    turned: control.turned,
    grab: projection.toFrame(part.point),
    projection,
    at,
  };
  drag = {
    ...part,
    pose,
    pointer: event.pointerId,
    button: event.button,
    wasMine: false,
    at,
    before: at,
    wheel: 0,
    shift: false,
    ctrl: false,
    isTouch: event.pointerType === "touch",
    began: performance.now(),
    from: at,
    isMoved: false,
    step: begin(start),
    now: null,
    sent: performance.now(),
    first: 0,
    axis:
      handle.aids && control.facing !== "view_facing" && aids.isAbout(control.mode)
        ? axisOf(start)
        : null,
  };
  setKeys(drag, event);
  canvas().setPointerCapture(event.pointerId);
  glow.light(part, "pressed");
  glow.dim(part.id);
  drag.first = send(drag, "press", { point: pointAt(at, part.id) });
  showAid(drag);
  return true;
}

/**
 * @param {Drag} drag
 * @param {PointerEvent} event
 */
function moveTo(drag, event) {
  drag.at = [event.clientX, event.clientY];
  setKeys(drag, event);
  requestRender();
}

/**
 * @param {Drag} drag
 * @param {WheelEvent} event
 */
function wheel(drag, event) {
  event.preventDefault();
  drag.wheel +=
    event.deltaMode === WheelEvent.DOM_DELTA_LINE ? event.deltaY / 3 : event.deltaY / 120;
  requestRender();
  return true;
}

/**
 * @param {Drag} drag
 * @param {MouseEvent | KeyboardEvent} event
 */
const setKeys = (drag, { shiftKey, ctrlKey, metaKey }) =>
  Object.assign(drag, { shift: shiftKey, ctrl: ctrlKey || metaKey });

// Once a frame, however many events there were.
function follow() {
  if (moved && !drag) {
    const { hover, target } = moved;
    point(target === canvas() ? known.controlAt(hover) : null);
  }
  moved = null;
  if (!drag) return;
  const { at, before } = drag;
  const isNews = at[0] !== before[0] || at[1] !== before[1] || drag.wheel;
  if (isNews) step(drag);
  const now = performance.now();
  const isResting = drag.isTouch && !drag.isMoved && now - drag.began > LONG_MS;
  if (isResting && known.all().get(drag.id)?.menu.length) return rest(drag);
  if (now - drag.sent > HOLD_MS) send(drag, "hold");
  requestRender();
}

/** @param {Drag} drag */
function step(drag) {
  const { at, before, wheel, shift, ctrl, from } = drag;
  const handle = known.all().get(drag.id);
  const node = frameNode(handle?.frame);
  drag.isMoved ||= Math.hypot(at[0] - from[0], at[1] - from[1]) > CLICK_PX;
  Object.assign(drag, { before: at, wheel: 0 });
  if (!node) return;
  /** @type {Vec2} */
  const by = [at[0] - before[0], at[1] - before[1]];
  const now = drag.step({ at, by, wheel, shift, ctrl }, projectionOf(node));
  if (!now || !isSane(now)) return;
  drag.now = now;
  poses.put(drag.id, drag.control, now);
  showAid(drag);
  send(drag, "move", placed(now));
}

/** @param {Moved | null} now */
const placed = (now) =>
  now ? { pose: { position: now.position, wxyz: now.wxyz }, turned: now.turned } : {};

/** @param {Moved} now */
const isSane = ({ position, wxyz }) =>
  position.every((value) => Math.abs(value) < 1e9) && wxyz.every(Number.isFinite);

/** @param {Drag} drag */
function release(drag) {
  if (drag.at !== drag.before) {
    step(drag);
    poses.placeNow();
  }
  const { id, control, now, at } = drag;
  const point = pointAt(at, id);
  send(drag, "release", { ...placed(now), point });
  end(drag);
  poses.letGo(id);
  if (known.controlOf({ id, control })?.mode === "menu") show({ id, control, at, point });
}

/**
 * A finger that rests opens the menu, like the right button of a mouse: as it is lifted, for that
 * would close a menu which is open by then.
 *
 * @param {Drag} drag
 */
function rest(drag) {
  const { id, control, at, pointer } = drag;
  send(drag, "release");
  end(drag);
  poses.letGo(id);
  asked = { id, control, at, pointer, isResting: true };
  navigator.vibrate?.(VIBRATE_MS);
}

/**
 * It was taken from this page: the server's pose counts.
 *
 * @param {Drag} lost
 */
function lose(lost) {
  end(lost);
  poses.letGo(lost.id);
}

/** @param {Drag} ended */
function end({ pointer }) {
  if (canvas().hasPointerCapture(pointer)) canvas().releasePointerCapture(pointer);
  drag = null;
  aids.show(null);
  glow.dim(null);
  glow.light(over, "over");
}

/**
 * @param {Asked} part
 * @param {PointerEvent} event
 */
function followAsked(part, event) {
  if (event.pointerId !== part.pointer) return true;
  const { at } = part;
  const isFar = Math.hypot(event.clientX - at[0], event.clientY - at[1]) > CLICK_PX;
  if (event.type === "pointerup" && (event.button === 2 || part.isResting)) {
    asked = null;
    if (part.isResting) canvas().addEventListener("touchend", keepOpen, KEEP_OPEN);
    if (!isFar) show({ ...part, point: pointAt(at, part.id) });
  } else if (event.type === "pointercancel") asked = null;
  return true;
}

/**
 * No click follows the finger, which would close the menu.
 *
 * @param {TouchEvent} event
 */
const keepOpen = (event) => event.preventDefault();

/** @param {Part & {at: Vec2, point: Vec3 | null}} asked */
function show({ id, control, at, point }) {
  const handle = known.all().get(id);
  if (!handle?.menu.length) return;
  // Not before the event of the pointer has ended, which closes menus elsewhere.
  const choose = (/** @type {number} */ entry) =>
    sendTo({ id, control }, "choose", { entry, point });
  setTimeout(() => menu.open(at, handle, choose));
}

/**
 * The point under the pointer, in the frame of a handle; null for nothing.
 *
 * @param {Vec2} at
 * @param {string} id
 */
function pointAt(at, id) {
  const node = frameNode(known.all().get(id)?.frame);
  const found = node && pickAt(at);
  return found ? projectionOf(node).toFrame(found.point) : null;
}

/** @param {Place | null} part */
function point(part) {
  over = part;
  glow.light(part, "over");
  canvas().style.cursor = part ? "pointer" : "";
  const words = part ? wordsOf(part) : "";
  if (words !== said) tellLive((said = words));
}

/** @param {Part} part */
function wordsOf(part) {
  const handle = known.all().get(part.id);
  const control = known.controlOf(part);
  return handle && control ? helpOf(handle, control, why("DragHandle")) : "";
}

/** @param {Drag} drag */
function showAid({ id, axis, now, pose }) {
  if (!axis) return;
  const object = frameNode(known.all().get(id)?.frame);
  aids.show(object ? { object, point: (now ?? pose).position, axis } : null);
}

/**
 * @param {Drag} drag
 * @param {SentDrag["kind"]} kind
 * @param {Partial<SentDrag>} [more]
 */
function send(drag, kind, more = {}) {
  drag.sent = performance.now();
  return sendTo(drag, kind, more);
}

/**
 * @param {Part} part
 * @param {SentDrag["kind"]} kind
 * @param {Partial<SentDrag>} more
 */
function sendTo({ id, control }, kind, more) {
  const [display, handle] = [id.slice(0, id.indexOf("/")), id.slice(id.indexOf("/") + 1)];
  return act.send("DragHandle", { display, drag: { handle, control, kind, ...more } });
}
