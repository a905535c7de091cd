// A drag of a handle: where the pointer moves it, and what the server gets of that.

import * as act from "webviz/act.js";
import { pickAt } from "webviz/scene/picking/pick.js";
import { frameNode, projectionOf } from "webviz/scene/projection.js";
import { requestRender } from "webviz/viser_page.js";
import * as aids from "webviz/features/handles/aids.js";
import { axisOf, begin } from "webviz/features/handles/drags.js";
import * as registry from "webviz/features/handles/registry.js";
import * as poses from "webviz/features/handles/poses.js";

/** @import {Commands} from "webviz/messages.js" */
/** @import {Moved} from "webviz/features/handles/drags.js" */
/** @import {Part} from "webviz/features/handles/registry.js" */
/** @import {Pose} from "webviz/vectors.js" */
/** @import {Vector3} from "three" */
/** @import {Vec2, Vec3} from "webviz/types.js" */

/**
 * @typedef {Commands["DragHandle"]["drag"]} SentDrag
 * @typedef {Part & {point: Vector3}} Place
 * @typedef {Part & {
 *   pose: Pose, pointer: number, button: number, wasMine: boolean, at: Vec2, before: Vec2,
 *   wheel: number, shift: boolean, ctrl: boolean, isTouch: boolean, began: number, from: Vec2,
 *   isMoved: boolean, step: ReturnType<typeof begin>, now: Moved | null, sentAt: number, first: number,
 *   axis: Vec3 | null,
 * }} Drag
 */

/** Pixels that a press may move and still be a click. */
export const CLICK_PX = 6;

/**
 * Takes hold of a control where an event presses it, null while its handle is not shown.
 *
 * @param {Place} part
 * @param {PointerEvent} event
 * @returns {Drag | null}
 */
export function grab(part, event) {
  const handle = registry.all().get(part.id);
  const control = registry.controlOf(part);
  const pose = poses.poseOf(part.id);
  const node = frameNode(handle?.frame);
  if (!handle || !control || !pose || !node) return null;
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
  /** @type {Drag} */
  const drag = {
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
    sentAt: performance.now(),
    first: 0,
    axis:
      handle.aids && control.facing !== "view_facing" && aids.isAbout(control.mode)
        ? axisOf(start)
        : null,
  };
  setKeys(drag, event);
  drag.first = send(drag, "press", { point: pointAt(at, part.id) });
  showAid(drag);
  return drag;
}

/**
 * @param {Drag} drag
 * @param {PointerEvent} event
 */
export function moveTo(drag, event) {
  drag.at = [event.clientX, event.clientY];
  setKeys(drag, event);
  requestRender();
}

/**
 * @param {Drag} drag
 * @param {WheelEvent} event
 */
export function wheel(drag, event) {
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
export const setKeys = (drag, { shiftKey, ctrlKey, metaKey }) =>
  Object.assign(drag, { shift: shiftKey, ctrl: ctrlKey || metaKey });

/** Moves the handle by what the pointer did since the last step. @param {Drag} drag */
export function step(drag) {
  const { at, before, wheel, shift, ctrl, from } = drag;
  const handle = registry.all().get(drag.id);
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

/**
 * Lets go: the server gets where the handle is, and the point under the pointer, which this returns.
 *
 * @param {Drag} drag
 */
export function release(drag) {
  if (drag.at !== drag.before) {
    step(drag);
    poses.placeNow();
  }
  const point = pointAt(drag.at, drag.id);
  send(drag, "release", { ...placed(drag.now), point });
  return point;
}

/**
 * The point under the pointer, in the frame of a handle; null for nothing.
 *
 * @param {Vec2} at
 * @param {string} id
 */
export function pointAt(at, id) {
  const node = frameNode(registry.all().get(id)?.frame);
  const hit = node && pickAt(at);
  return hit ? projectionOf(node).toFrame(hit.point) : null;
}

/** @param {Drag} drag */
function showAid({ id, axis, now, pose }) {
  if (!axis) return;
  const object = frameNode(registry.all().get(id)?.frame);
  aids.show(object ? { object, point: (now ?? pose).position, axis } : null);
}

/**
 * @param {Drag} drag
 * @param {SentDrag["kind"]} kind
 * @param {Partial<SentDrag>} [more]
 */
export function send(drag, kind, more = {}) {
  drag.sentAt = performance.now();
  return sendTo(drag, kind, more);
}

/**
 * @param {Part} part
 * @param {SentDrag["kind"]} kind
 * @param {Partial<SentDrag>} more
 */
export function sendTo({ id, control }, kind, more) {
  const [display, handle] = [id.slice(0, id.indexOf("/")), id.slice(id.indexOf("/") + 1)];
  return act.send("DragHandle", { display, drag: { handle, control, kind, ...more } });
}
