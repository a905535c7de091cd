// Follows the gesture of a tool and draws its preview, without asking the server.

import { set, svgElement } from "../dom.js";
import { arrowAt } from "./arrow.js";
import { makeLayer } from "./layer.js";
import { sendCard } from "./send_card.js";
import { fixed } from "./numbers.js";
import { canvas } from "../viser_page.js";
import { heightAt, onCanvas, planeAt, surfaceAt } from "../scene/ground.js";

const CLICK_PX = 4;

let drawing = null;
let stroke = null;

/**
 * Begins to follow a pointer, instead of what still waits to be sent. `done` gets the points, the
 * heading and the keys, `live` in words where the gesture is. False where there is nothing to begin
 * on.
 */
export function begin(event, tool, { done, live }) {
  /** @type {[number, number]} */
  const at = [event.clientX, event.clientY];
  const start = tool.surface ? surfaceAt(at) : planeAt(at, 0);
  if (start === null) return false;
  cancel();
  const turned = { yaw: 0, isTurned: false, isLifting: false, finger: null, raised: 0 };
  stroke = { tool, done, live, start, at, from: at, pointer: event.pointerId, ...turned };
  canvas().setPointerCapture(event.pointerId);
  follow(event);
  redraw(stroke);
  return true;
}

export const isGoing = () => stroke !== null && !stroke.made;
export const isWaiting = () => Boolean(stroke?.made);
export const follows = (event) => isGoing() && stroke.pointer === event.pointerId;

/** Takes up where the pointer is; with Ctrl it lifts, else it turns. */
export function follow(event) {
  const before = stroke.at;
  stroke.at = [event.clientX, event.clientY];
  if (stroke.tool.gesture === "pose") {
    if (event.ctrlKey) {
      stroke.isLifting = true;
      lift(before, stroke.at);
    } else {
      if (stroke.isLifting) stroke.from = before; // what was moved to lift it does not turn it
      stroke.isLifting = false;
      const [x, y] = stroke.from;
      if (stroke.isTurned || Math.hypot(event.clientX - x, event.clientY - y) >= CLICK_PX) turn();
    }
  }
  stroke.live(words());
}

/** Takes up where another finger is: moving it up or down lifts, and does not turn. */
export function followSecond({ type, pointerId, pointerType, clientY }) {
  if (stroke.tool.gesture !== "pose" || pointerType !== "touch") return;
  if (type === "pointerdown") stroke.finger ??= { pointerId, y: clientY };
  if (stroke.finger?.pointerId !== pointerId) return;
  if (type === "pointermove") {
    const { left, top } = canvas().getBoundingClientRect();
    const [x, y] = onCanvas(stroke.start) ?? [0, 0];
    const from = [left + x, top + y];
    stroke.raised += lift(from, [from[0], from[1] + clientY - stroke.finger.y]);
    stroke.finger.y = clientY;
    stroke.live(words());
  } else if (type !== "pointerdown") stroke.finger = null;
}

// The start goes up along a vertical line as much as what moved from one point of the window to
// another.
function lift(...points) {
  const [from, to] = points.map((xy) => heightAt(xy, stroke.start));
  const metres = from === null || to === null ? 0 : to - from;
  stroke.start[2] += metres;
  return metres;
}

// Where the pointer is at the height of the start, were it not for the other finger.
function ahead() {
  const { start, at, raised } = stroke;
  const point = planeAt(at, start[2] - raised);
  return point && [point[0], point[1], start[2]];
}

function turn() {
  const { start } = stroke;
  const point = ahead();
  if (point === null) return;
  stroke.isTurned = true;
  stroke.yaw = Math.atan2(point[1] - start[1], point[0] - start[0]);
}

/** Ends a gesture; its preview stays until it is sent, if somebody `asks`. */
export function end(event, asks) {
  follow(event);
  const { start, yaw, isTurned } = stroke;
  const last = isTurned ? ahead() : null;
  const keys = ["shift", "ctrl", "alt", "meta"].filter((key) => event[`${key}Key`]);
  stroke.made = { points: last === null ? [start] : [start, last], yaw, keys };
  if (asks) wait();
  else send();
}

/** Shows a gesture as it was made, `{points, yaw, keys}`, until it is sent. */
export function propose(tool, made, { done, live }) {
  cancel();
  stroke = { tool, done, live, start: made.points[0], yaw: made.yaw, made };
  redraw(stroke);
  wait();
}

function wait() {
  stroke.live(`${words()} · Enter sends, Esc cancels.`);
  stroke.card = sendCard(send, cancel);
  drawing.layer.element.append(stroke.card.element);
  stroke.card.focus();
}

/** Sends what waits for that. */
export function send() {
  const { done, made } = stroke;
  cancel();
  done(made);
}

export function cancel() {
  if (stroke === null) return;
  const { pointer } = stroke;
  if (pointer !== undefined && canvas().hasPointerCapture(pointer))
    canvas().releasePointerCapture(pointer);
  stroke.live("");
  stroke = null;
  drawing?.layer.element.remove();
  drawing = null;
}

function words() {
  const { tool, start, yaw } = stroke;
  const [x, y, z] = start.map((number) => fixed(number, 2));
  const heading = tool.gesture === "pose" ? ` · yaw ${fixed((yaw * 180) / Math.PI, 1)}°` : "";
  return `x ${x} y ${y} z ${z} m${heading}`;
}

function redraw(shown) {
  if (stroke !== shown) return;
  requestAnimationFrame(() => redraw(shown)); // the view may follow a frame that moves
  drawing ??= makeDrawing();
  const { layer, stem, arrow, dot } = drawing;
  const { tool, start, yaw } = stroke;
  layer.place();
  set(arrow, { points: ((tool.gesture === "pose" && arrowAt(start, yaw)) || []).join(" ") });
  const top = onCanvas(start) ?? [-100, -100];
  const isLifted = tool.gesture === "pose" && start[2] !== 0;
  const foot = (isLifted && onCanvas([start[0], start[1], 0])) || top;
  set(stem, { x1: top[0], y1: top[1], x2: foot[0], y2: foot[1] });
  set(dot, { cx: top[0], cy: top[1] });
  /** @type {[number, number, number]} */
  const heading = [start[0] + Math.cos(yaw), start[1] + Math.sin(yaw), start[2]];
  stroke.card?.place(onCanvas(start), tool.gesture === "pose" && onCanvas(heading));
}

function makeDrawing() {
  const stem = svgElement("line", { class: "wv-preview-stem" });
  const arrow = svgElement("polygon", { class: "wv-preview-arrow" });
  const dot = svgElement("circle", { class: "wv-preview-start", r: 4 });
  return { layer: makeLayer("preview", svgElement("svg", {}, stem, arrow, dot)), stem, arrow, dot };
}
