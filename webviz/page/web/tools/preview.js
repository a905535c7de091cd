// Follows the gesture of a tool and draws its preview, without asking the server.

import { set, svgElement } from "webviz/dom.js";
import { signal } from "webviz/signals.js";
import { arrowAt } from "webviz/tools/arrow.js";
import { makeLayer } from "webviz/tools/layer.js";
import { sendCard } from "webviz/tools/send_card.js";
import { fixed } from "webviz/numbers.js";
import { canvas } from "webviz/viser_page.js";
import { heightAt, onCanvas, planeAt, surfaceAt } from "webviz/scene/ground.js";

/** @import {MadeGesture, ToolFacts, Vec2, Vec3} from "webviz/types.js" */

/**
 * @typedef {{onEnd: (made: MadeGesture) => void, live: (text: string) => void}} Listener
 * @typedef {Listener & {
 *   tool: ToolFacts, start: Vec3, yaw: number, at: Vec2, from: Vec2, pointer: number | null,
 *   isTurned: boolean, isLifting: boolean, finger: {pointerId: number, y: number} | null,
 *   raised: number, result: MadeGesture | null, card: ReturnType<typeof sendCard> | null,
 *   drawing: ReturnType<typeof makeDrawing>,
 * }} Preview
 */

const CLICK_PX = 4;
/** @type {Omit<Preview, "tool" | "start" | "drawing" | keyof Listener>} */
const AT_REST = {
  yaw: 0,
  at: [0, 0],
  from: [0, 0],
  pointer: null,
  isTurned: false,
  isLifting: false,
  finger: null,
  raised: 0,
  result: null,
  card: null,
};

const currentPreview = signal(/** @type {Preview | null} */ (null));

/**
 * Begins to follow a pointer, instead of what still waits to be sent. `done` gets the points, the
 * heading and the keys, `live` in words where the gesture is. False where there is nothing to begin
 * on.
 *
 * @param {PointerEvent} event
 * @param {ToolFacts} tool
 * @param {Listener} listener
 */
export function begin(event, tool, { onEnd, live }) {
  /** @type {Vec2} */
  const at = [event.clientX, event.clientY];
  const start = tool.surface ? surfaceAt(at) : planeAt(at, 0);
  if (start === null) return false;
  show({ tool, onEnd, live, start, at, from: at, pointer: event.pointerId });
  canvas().setPointerCapture(event.pointerId);
  follow(event);
  return true;
}

/**
 * Shows a preview in place of another one.
 *
 * @param {Listener & Pick<Preview, "tool" | "start"> & Partial<Preview>} preview
 */
function show(preview) {
  cancel();
  const next = { ...AT_REST, ...preview, drawing: makeDrawing() };
  currentPreview.value = next;
  redraw(next);
  return next;
}

export const isGoing = () => currentPreview.value !== null && !currentPreview.value.result;
export const isWaiting = () => Boolean(currentPreview.value?.result);
/** @param {PointerEvent} event */
export const follows = (event) => isGoing() && currentPreview.value?.pointer === event.pointerId;

/**
 * Takes up where the pointer is; with Ctrl it lifts, else it turns.
 *
 * @param {PointerEvent} event
 */
export function follow(event) {
  const current = currentPreview.value;
  if (!current) return;
  const before = current.at;
  current.at = [event.clientX, event.clientY];
  if (current.tool.gesture === "pose") {
    if (event.ctrlKey) {
      current.isLifting = true;
      lift(current, before, current.at);
    } else {
      if (current.isLifting) current.from = before; // what was moved to lift it does not turn it
      current.isLifting = false;
      const [x, y] = current.from;
      const isFar = Math.hypot(event.clientX - x, event.clientY - y) >= CLICK_PX;
      if (current.isTurned || isFar) turn(current);
    }
  }
  current.live(words(current));
}

/**
 * Takes up where another finger is: moving it up or down lifts, and does not turn.
 *
 * @param {PointerEvent} event
 */
export function followSecond({ type, pointerId, pointerType, clientY }) {
  const current = currentPreview.value;
  if (current?.tool.gesture !== "pose" || pointerType !== "touch") return;
  if (type === "pointerdown") current.finger ??= { pointerId, y: clientY };
  if (current.finger?.pointerId !== pointerId) return;
  if (type === "pointermove") {
    const { left, top } = canvas().getBoundingClientRect();
    const [x, y] = onCanvas(current.start) ?? [0, 0];
    const by = clientY - current.finger.y;
    current.raised += lift(current, [left + x, top + y], [left + x, top + y + by]);
    current.finger.y = clientY;
    current.live(words(current));
  } else if (type !== "pointerdown") current.finger = null;
}

/**
 * Lifts the start along a vertical line as much as what moved from one point of the window to
 * another; returns by how many metres.
 *
 * @param {Preview} current
 * @param {Vec2} before
 * @param {Vec2} now
 */
function lift({ start }, before, now) {
  const [from, to] = [heightAt(before, start), heightAt(now, start)];
  const metres = from === null || to === null ? 0 : to - from;
  start[2] += metres;
  return metres;
}

/**
 * Return where the pointer is at the height of the start, were it not for the other finger.
 *
 * @param {Preview} current
 * @returns {Vec3 | null}
 */
function ahead({ start, at, raised }) {
  const point = planeAt(at, start[2] - raised);
  return point && [point[0], point[1], start[2]];
}

/** @param {Preview} current */
function turn(current) {
  const { start } = current;
  const point = ahead(current);
  if (point === null) return;
  current.isTurned = true;
  current.yaw = Math.atan2(point[1] - start[1], point[0] - start[0]);
}

/**
 * Ends a gesture; its preview stays until it is sent, if the tool `asks`.
 *
 * @param {PointerEvent} event
 * @param {boolean} asks
 */
export function end(event, asks) {
  const current = currentPreview.value;
  if (!current) return;
  follow(event);
  const { start, yaw, isTurned } = current;
  const last = isTurned ? ahead(current) : null;
  const { shiftKey: shift, ctrlKey: ctrl, altKey: alt, metaKey: meta } = event;
  const modifiers = Object.entries({ shift, ctrl, alt, meta }).filter(([, isHeld]) => isHeld);
  const keys = modifiers.map(([key]) => key);
  current.result = { points: last === null ? [start] : [start, last], yaw, keys };
  if (asks) wait(current);
  else send();
}

/**
 * Shows a gesture as it was made, `{points, yaw, keys}`, until it is sent.
 *
 * @param {ToolFacts} tool
 * @param {MadeGesture} result
 * @param {Listener} listener
 */
export function propose(tool, result, { onEnd, live }) {
  wait(show({ tool, onEnd, live, start: result.points[0], yaw: result.yaw, result }));
}

/** @param {Preview} current */
function wait(current) {
  current.live(`${words(current)} · Enter sends, Esc cancels.`);
  current.card = sendCard(send, cancel);
  current.drawing.layer.element.append(current.card.element);
  current.card.focus();
}

/** Sends what waits for that. */
export function send() {
  if (!currentPreview.value?.result) return;
  const { onEnd, result } = currentPreview.value;
  cancel();
  onEnd(result);
}

export function cancel() {
  if (currentPreview.value === null) return;
  const { pointer, live, drawing } = currentPreview.value;
  if (pointer !== null && canvas().hasPointerCapture(pointer))
    canvas().releasePointerCapture(pointer);
  live("");
  currentPreview.value = null;
  drawing.layer.element.remove();
}

/** @param {Preview} current */
function words({ tool, start, yaw }) {
  const [x, y, z] = start.map((number) => fixed(number, 2));
  const heading = tool.gesture === "pose" ? ` · yaw ${fixed((yaw * 180) / Math.PI, 1)}°` : "";
  return `x ${x} y ${y} z ${z} m${heading}`;
}

/** @param {Preview} current */
function redraw(current) {
  if (currentPreview.value !== current) return;
  requestAnimationFrame(() => redraw(current)); // the view may follow a frame that moves
  const { layer, stem, arrow, dot } = current.drawing;
  const { tool, start, yaw } = current;
  const isPose = tool.gesture === "pose";
  layer.place();
  set(arrow, { points: ((isPose && arrowAt(start, yaw)) || []).join(" ") });
  const top = onCanvas(start) ?? [-100, -100];
  const isLifted = isPose && start[2] !== 0;
  const foot = (isLifted && onCanvas([start[0], start[1], 0])) || top;
  set(stem, { x1: top[0], y1: top[1], x2: foot[0], y2: foot[1] });
  set(dot, { cx: top[0], cy: top[1] });
  /** @type {Vec3} */
  const heading = [start[0] + Math.cos(yaw), start[1] + Math.sin(yaw), start[2]];
  current.card?.place(onCanvas(start), isPose ? onCanvas(heading) : null);
}

function makeDrawing() {
  const stem = svgElement("line", { class: "wv-preview-stem" });
  const arrow = svgElement("polygon", { class: "wv-preview-arrow" });
  const dot = svgElement("circle", { class: "wv-preview-start", r: 4 });
  return { layer: makeLayer("preview", svgElement("svg", {}, stem, arrow, dot)), stem, arrow, dot };
}
