// Follows a gesture on the ground and draws its preview, without asking the server.

import { groundAt, onCanvas } from "./ground.js";
import { canvas } from "../viser_page.js";

// RViz's arrow, in metres: a shaft and a head. It is never too small to see, nor too large.
const SHAFT = [2.0, 0.1];
const HEAD = [0.5, 0.175];
const SHORTEST_PX = 60;
const LONGEST = 0.35; // of the height of the scene
const CLICK_PX = 4;

const SVG = "http://www.w3.org/2000/svg";
const yaws = new Map();
let overlay = null;
let stroke = null;

/** Begins to follow a pointer; `done` gets the points, the heading and the keys. */
export function begin(event, tool, done) {
  const start = groundAt(event.clientX, event.clientY);
  if (start === null) return false;
  const at = [event.clientX, event.clientY];
  stroke = { tool, done, start, pointer: event.pointerId, from: at, at, isDragged: false };
  canvas().setPointerCapture(event.pointerId);
  redraw();
  return true;
}

export const isGoing = () => stroke !== null;
export const follows = (event) => stroke !== null && stroke.pointer === event.pointerId;

export function move(event) {
  stroke.at = [event.clientX, event.clientY];
  const [x, y] = stroke.from;
  if (Math.hypot(event.clientX - x, event.clientY - y) >= CLICK_PX) stroke.isDragged = true;
}

export function end(event) {
  move(event);
  const { tool, start, done } = stroke;
  const yaw = heading();
  const last = stroke.isDragged ? groundAt(...stroke.at) : null;
  if (tool.gesture === "pose") yaws.set(tool.id, yaw);
  cancel();
  const keys = ["shift", "ctrl", "alt", "meta"].filter((key) => event[`${key}Key`]);
  done({ points: last === null ? [start] : [start, last], yaw, keys });
}

export function cancel() {
  if (stroke === null) return;
  if (canvas().hasPointerCapture(stroke.pointer)) canvas().releasePointerCapture(stroke.pointer);
  stroke = null;
  overlay?.remove();
  overlay = null;
}

// A click keeps the heading of the stroke before, and the preview shows it from the press on.
function heading() {
  const { tool, start, at, isDragged } = stroke;
  const point = isDragged ? groundAt(...at) : null;
  if (point === null) return stroke.yaw ?? yaws.get(tool.id) ?? 0;
  return (stroke.yaw = Math.atan2(point[1] - start[1], point[0] - start[0]));
}

function redraw() {
  if (stroke === null) return;
  requestAnimationFrame(redraw); // the view may follow a frame that moves
  overlay ??= makeOverlay();
  const box = canvas().getBoundingClientRect();
  for (const side of ["left", "top", "width", "height"]) overlay.style[side] = `${box[side]}px`;
  const points = stroke.tool.gesture === "pose" ? arrow(stroke.start, heading()) : null;
  overlay.firstChild.setAttribute("points", (points ?? []).join(" "));
  const [x, y] = onCanvas(stroke.start) ?? [-100, -100];
  overlay.lastChild.setAttribute("cx", x);
  overlay.lastChild.setAttribute("cy", y);
}

function makeOverlay() {
  const svg = document.createElementNS(SVG, "svg");
  svg.dataset.webviz = "preview";
  svg.style.cssText = "position: fixed; pointer-events: none; z-index: 5; overflow: hidden";
  const polygon = document.createElementNS(SVG, "polygon");
  polygon.setAttribute("fill", "rgba(0, 255, 0, 0.75)");
  polygon.setAttribute("stroke", "rgba(0, 60, 0, 0.9)");
  const dot = document.createElementNS(SVG, "circle");
  dot.setAttribute("r", 4);
  dot.setAttribute("fill", "white");
  dot.setAttribute("stroke", "black");
  svg.append(polygon, dot);
  document.body.append(svg);
  return svg;
}

function arrow([x, y], yaw) {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  const [from, to] = [[x, y, 0], [x + 0.01 * c, y + 0.01 * s, 0]].map(onCanvas);
  if (from === null || to === null) return null;
  const perMeter = 100 * Math.hypot(to[0] - from[0], to[1] - from[1]);
  const length = SHAFT[0] + HEAD[0];
  const longest = LONGEST * canvas().clientHeight;
  const wanted = Math.min(Math.max(length * perMeter, SHORTEST_PX), longest);
  const scale = perMeter > 0 ? wanted / (length * perMeter) : 1;
  const shape = [
    [0, SHAFT[1]], [SHAFT[0], SHAFT[1]], [SHAFT[0], HEAD[1]], [length, 0],
    [SHAFT[0], -HEAD[1]], [SHAFT[0], -SHAFT[1]], [0, -SHAFT[1]],
  ];
  const corners = shape.map(([ahead, left]) =>
    onCanvas([x + scale * (ahead * c - left * s), y + scale * (ahead * s + left * c), 0]),
  );
  return corners.includes(null) ? null : corners;
}
