// Gestures of the pointer on handles while the tool Interact is active.

import { why } from "../access.js";
import * as act from "../act.js";
import * as channel from "../channel.js";
import { pickAt } from "../scene/picking/pick.js";
import { tell, tellLive } from "../tools/hint.js";
import { canvas, eachFrame, requestRender } from "../viser_page.js";
import * as aids from "./aids.js";
import { axisOf, begin } from "./drags.js";
import * as glow from "./glow.js";
import * as known from "./known.js";
import * as menu from "./menu.js";
import * as poses from "./poses.js";
import { frameNode, sightOf } from "./sight.js";

const HOLD_MS = 500; // after which the server is told that the drag goes on
const LONG_MS = 600; // that a finger rests for the menu
const VIBRATE_MS = 15;
const CLICK_PX = 6;
const BEFORE_PLACING = -1001;
const DOES = { menu: "Show menu", button: "Activate" };
const TURNS = /^rotate/;

let over = null; // what the pointer is on
let drag = null;
let asked = null; // a press of the right button, or of a finger that may rest
let moved = null; // where the pointer went since the last frame
let said = "";

export function install() {
  aids.install();
  eachFrame(BEFORE_PLACING, follow);
  known.onChange(() => {
    const handle = drag && known.all().get(drag.id);
    if (drag && (!handle || (drag.wasMine && handle.holder !== window.webviz.browser))) lose();
    else if (drag) drag.wasMine ||= handle.holder === window.webviz.browser;
  });
  act.onAnswer("GripHandle", ({ number, text }) => {
    tell("warn", text);
    if (drag && number >= drag.first) lose();
  });
  channel.onOpen(() => drag && lose());
  window.addEventListener(
    "keydown",
    (event) => {
      if (event.key === "Escape" && drag) {
        event.stopImmediatePropagation();
        release();
      } else if (drag) setKeys(event);
    },
    true,
  );
  window.addEventListener("keyup", (event) => drag && setKeys(event), true);
}

/** Ends what goes on. */
export function leave() {
  if (drag) release();
  point(null);
}

/** Takes an event of the pointer over the scene; whether it is none of the camera. */
export function pointer(event) {
  const { type, pointerId, button, clientX, clientY } = event;
  if (!known.all().size) return false;
  if (type === "wheel") return Boolean(drag) && wheel(event);
  if (drag) {
    if (pointerId !== drag.pointer) return true;
    if (type === "pointermove") moveTo(event);
    else if (type === "pointercancel" || (type === "pointerup" && button === drag.button))
      release();
    return true;
  }
  if (asked && type !== "pointerdown") return followAsked(event);
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

function press(part, event) {
  const handle = known.all().get(part.id);
  const refusal =
    why("GripHandle") ||
    handle.refusal ||
    (handle.holder !== null && `Browser ${handle.holder} holds it.`);
  if (refusal) {
    tell("warn", refusal);
    return true;
  }
  const pose = poses.poseOf(part.id);
  const node = frameNode(handle.frame);
  if (!pose || !node) return false;
  const control = known.controlOf(part);
  const at = [event.clientX, event.clientY];
  const sight = sightOf(node);
  const start = {
    control,
    pose,
    turned: control.turned,
    grab: sight.toFrame(part.point),
    sight,
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
    isTouch: event.pointerType === "touch",
    began: performance.now(),
    from: at,
    isMoved: false,
    step: begin(start),
    now: null,
    sent: performance.now(),
    axis:
      handle.aids && control.facing !== "view_facing" && aids.isAbout(control.mode)
        ? axisOf(start)
        : null,
  };
  setKeys(event);
  canvas().setPointerCapture(event.pointerId);
  glow.light(part, "pressed");
  glow.dim(part.id);
  drag.first = send("press");
  showAid();
  return true;
}

function moveTo(event) {
  drag.at = [event.clientX, event.clientY];
  setKeys(event);
  requestRender();
}

function wheel(event) {
  event.preventDefault();
  drag.wheel +=
    event.deltaMode === WheelEvent.DOM_DELTA_LINE ? event.deltaY / 3 : event.deltaY / 120;
  requestRender();
  return true;
}

const setKeys = ({ shiftKey, ctrlKey, metaKey }) =>
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
  if (isNews) step();
  const now = performance.now();
  const isResting = drag.isTouch && !drag.isMoved && now - drag.began > LONG_MS;
  if (isResting && known.all().get(drag.id)?.menu.length) return rest();
  if (now - drag.sent > HOLD_MS) send("hold");
  requestRender();
}

function step() {
  const { at, before, wheel, shift, ctrl, from } = drag;
  const handle = known.all().get(drag.id);
  const node = frameNode(handle?.frame);
  drag.isMoved ||= Math.hypot(at[0] - from[0], at[1] - from[1]) > CLICK_PX;
  Object.assign(drag, { before: at, wheel: 0 });
  if (!node) return;
  const by = [at[0] - before[0], at[1] - before[1]];
  const now = drag.step({ at, by, wheel, shift, ctrl }, sightOf(node));
  if (!now || !isSane(now)) return;
  drag.now = now;
  poses.put(drag.id, drag.control, now);
  showAid();
  send("move", placed(now));
}

const placed = (now) =>
  now ? { pose: { position: now.position, wxyz: now.wxyz }, turned: now.turned } : {};

const isSane = ({ position, wxyz }) =>
  position.every((value) => Math.abs(value) < 1e9) && wxyz.every(Number.isFinite);

function release() {
  if (drag.at !== drag.before) step();
  const { id, control, now, at } = drag;
  const point = pointAt(at);
  send("release", { ...placed(now), point });
  end();
  poses.letGo(id);
  if (known.controlOf({ id, control })?.mode === "menu") show({ id, control, at, point });
}

// A finger that rests opens the menu, like the right button of a mouse: as it is lifted, for that
// would close a menu which is open by then.
function rest() {
  const { id, control, at, pointer } = drag;
  send("release", {});
  end();
  poses.letGo(id);
  asked = { id, control, at, pointer, isResting: true };
  navigator.vibrate?.(VIBRATE_MS);
}

// It was taken from this page: the server's pose counts.
function lose() {
  const { id } = drag;
  end();
  poses.letGo(id);
}

function end() {
  if (canvas().hasPointerCapture(drag.pointer)) canvas().releasePointerCapture(drag.pointer);
  drag = null;
  aids.show(null);
  glow.dim(null);
  glow.light(over, "over");
}

function followAsked(event) {
  if (event.pointerId !== asked.pointer) return true;
  const { at } = asked;
  const isFar = Math.hypot(event.clientX - at[0], event.clientY - at[1]) > CLICK_PX;
  if (event.type === "pointerup" && (event.button === 2 || asked.isResting)) {
    const part = asked;
    asked = null;
    if (!isFar) show({ ...part, point: pointAt(at, part.id) });
  } else if (event.type === "pointercancel") asked = null;
  return true;
}

function show({ id, control, at, point }) {
  const handle = known.all().get(id);
  if (!handle?.menu.length) return;
  // Not before the event of the pointer has ended, which closes menus elsewhere.
  const choose = (entry) => sendTo({ id, control }, "choose", { entry, point });
  setTimeout(() => menu.open(at, handle, choose));
}

// The point under the pointer, in the frame of the dragged handle; null for nothing.
function pointAt(at, id = drag?.id) {
  const node = frameNode(known.all().get(id)?.frame);
  const found = node && pickAt(at);
  return found ? sightOf(node).toFrame(found.point) : null;
}

function point(part) {
  over = part;
  glow.light(part, "over");
  canvas().style.cursor = part ? "pointer" : "";
  const words = part ? wordsOf(part) : "";
  if (words !== said) tellLive((said = words));
}

function wordsOf(part) {
  const handle = known.all().get(part.id);
  const reason = why("GripHandle");
  if (reason) return `${handle.name}: ${reason}`;
  const { mode, help } = known.controlOf(part);
  const does = DOES[mode] ?? (TURNS.test(mode) ? "Rotate" : "Move");
  const holder = handle.holder === null ? "" : `Browser ${handle.holder} holds it.`;
  const more = mode !== "menu" && handle.menu.length ? "Right-click: Show context menu." : "";
  return [help || handle.name, `Left-click: ${does}.`, more, holder].filter(Boolean).join(" ");
}

function showAid() {
  const { id, axis, now, pose } = drag;
  if (axis) aids.show(frameNode(known.all().get(id)?.frame), (now ?? pose).position, axis);
}

function send(kind, more = {}) {
  drag.sent = performance.now();
  return sendTo(drag, kind, kind === "press" ? { point: pointAt(drag.at), ...more } : more);
}

function sendTo({ id, control }, kind, more) {
  const [display, handle] = [id.slice(0, id.indexOf("/")), id.slice(id.indexOf("/") + 1)];
  return act.send("GripHandle", { display, grip: { handle, control, kind, ...more } });
}
