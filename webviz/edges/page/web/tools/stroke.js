// Follows the gesture of a tool and draws its preview, without asking the server.

import { set, svgElement } from "../dom.js";
import { arrowAt } from "./arrow.js";
import { makeLayer } from "./layer.js";
import { fixed } from "./numbers.js";
import { canvas } from "../viser_page.js";
import { heightAt, onCanvas, planeAt, surfaceAt } from "../scene/ground.js";

const CLICK_PX = 4;

let drawing = null;
let stroke = null;

/**
 * Begins to follow a pointer. `done` gets the points, the heading and the keys, `live` in words
 * where the gesture is. False where there is nothing to begin on.
 */
export function begin(event, tool, { done, live }) {
  const at = [event.clientX, event.clientY];
  const start = tool.surface ? surfaceAt(at) : planeAt(at, 0);
  if (start === null) return false;
  const turned = { yaw: 0, isTurned: false, isLifting: false };
  stroke = { tool, done, live, start, at, from: at, pointer: event.pointerId, ...turned };
  canvas().setPointerCapture(event.pointerId);
  follow(event);
  redraw();
  return true;
}

export const isGoing = () => stroke !== null;
export const follows = (event) => stroke !== null && stroke.pointer === event.pointerId;

/** Takes up where the pointer is; with Ctrl it lifts, else it turns. */
export function follow(event) {
  const before = stroke.at;
  stroke.at = [event.clientX, event.clientY];
  if (stroke.tool.gesture === "pose") {
    if (event.ctrlKey) lift(before);
    else {
      if (stroke.isLifting) stroke.from = before; // what was moved to lift it does not turn it
      stroke.isLifting = false;
      const [x, y] = stroke.from;
      if (stroke.isTurned || Math.hypot(event.clientX - x, event.clientY - y) >= CLICK_PX) turn();
    }
  }
  stroke.live(words());
}

// The start goes up as the pointer does along a vertical line, from where it was when Ctrl was
// pressed.
function lift(before) {
  const { start, at } = stroke;
  const [from, to] = [before, at].map((xy) => heightAt(xy, start));
  stroke.isLifting = true;
  if (from !== null && to !== null) start[2] += to - from;
}

function turn() {
  const { start, at } = stroke;
  const point = planeAt(at, start[2]);
  if (point === null) return;
  stroke.isTurned = true;
  stroke.yaw = Math.atan2(point[1] - start[1], point[0] - start[0]);
}

export function end(event) {
  follow(event);
  const { done, start, yaw, isTurned, at } = stroke;
  const last = isTurned ? planeAt(at, start[2]) : null;
  cancel();
  const keys = ["shift", "ctrl", "alt", "meta"].filter((key) => event[`${key}Key`]);
  done({ points: last === null ? [start] : [start, last], yaw, keys });
}

export function cancel() {
  if (stroke === null) return;
  if (canvas().hasPointerCapture(stroke.pointer)) canvas().releasePointerCapture(stroke.pointer);
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

function redraw() {
  if (stroke === null) return;
  requestAnimationFrame(redraw); // the view may follow a frame that moves
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
}

function makeDrawing() {
  const stem = svgElement("line", { class: "wv-preview-stem" });
  const arrow = svgElement("polygon", { class: "wv-preview-arrow" });
  const dot = svgElement("circle", { class: "wv-preview-start", r: 4 });
  return { layer: makeLayer("preview", svgElement("svg", {}, stem, arrow, dot)), stem, arrow, dot };
}
