// The tool that measures between points of surfaces. Its lines stay where they are in the fixed
// frame.

import { NOT_COPIED, copy } from "webviz/clipboard.js";
import { el, set, setText, svgElement } from "webviz/dom.js";
import { onCanvas, surfaceAt } from "webviz/scene/ground.js";
import { watch } from "webviz/stores.js";
import * as viser from "webviz/viser_page.js";
import { clicks } from "webviz/tools/clicks.js";
import { tell, tellLive } from "webviz/tools/hint.js";
import { makeLayer } from "webviz/tools/layer.js";
import { fixed } from "webviz/numbers.js";

/** @import {Tool, Vec2, Vec3} from "webviz/types.js" */

/**
 * @typedef {{
 *   from: Vec3, to: Vec3 | null, parts: SVGLineElement[], ends: SVGCircleElement[],
 *   label: HTMLButtonElement, length: HTMLElement, steps: HTMLElement,
 * }} Line
 */

const MAX_LINES = 50;
const MAX_WAIT_MS = 250; // between looks at what is below the pointer
const HINT = "Click on two points. Right click clears, Esc leaves.";

/** @type {Line[]} */
const lines = [];
/** @type {Line | null} */
let open = null; // the line that has no end yet
/** @type {ReturnType<typeof makeLayer> | null} */
let layer = null;
/** @type {SVGSVGElement | null} */
let drawing = null;
/** @type {Vec2 | null} */
let pointer = null;
let isWaiting = false;
/** @type {string | null} */
let frame = null;

/** @type {Tool} */
export const measure = {
  id: "measure",
  name: "Measure",
  shortcut: "n",
  icon: "ruler",
  order: 4,
  isLean: true,
  hint: HINT,
  tooltip: "Measure between points.",
  cursor: "crosshair",
  pointer: clicks(press, clear, move),
  select: install,
  leave() {
    pointer = null;
    if (open) remove(open);
  },
};

function install() {
  if (layer) return;
  drawing = svgElement("svg");
  layer = makeLayer("measure", drawing);
  viser.beforeRender(draw);
  // Numbers of another frame would be elsewhere.
  watch("settings", (settings) => {
    const now = settings.get("fixed_frame");
    if (frame !== null && now !== frame) removeAll();
    frame = now;
  });
}

/**
 * @param {PointerEvent} event
 * @returns {void}
 */
function press(event) {
  const point = surfaceAt([event.clientX, event.clientY]);
  if (point === null) return tell("warn", "Nothing is there. Click on a surface or on the ground.");
  if (open) {
    open.to = point;
    finish(open);
  } else {
    if (lines.length >= MAX_LINES) remove(lines[0]);
    open = makeLine(point);
  }
  viser.requestRender();
}

/** @param {Line} line */
function finish(line) {
  set(line.label, { "data-live": null, tabindex: 0 });
  open = null;
  tellLive("");
}

// A right click gives up the line that has no end, or clears all.
function clear() {
  if (open) remove(open);
  else removeAll();
  tellLive("");
}

/**
 * A ray through a large cloud takes long: the next one waits as long as four of them.
 *
 * @param {PointerEvent} event
 */
function move(event) {
  pointer = [event.clientX, event.clientY];
  if (open && !isWaiting) requestAnimationFrame(look);
  isWaiting ||= open !== null;
}

function look() {
  const [before, at, line] = [performance.now(), pointer, open];
  const point = line && at && surfaceAt(at);
  if (point) {
    line.to = point;
    tellLive(words(line));
    draw();
  }
  const next = () => {
    isWaiting = open !== null && pointer !== at;
    if (isWaiting) requestAnimationFrame(look);
  };
  setTimeout(next, Math.min(4 * (performance.now() - before), MAX_WAIT_MS));
}

/** @param {Vec3} from */
function makeLine(from) {
  const [length, steps] = [el("b"), el("span")];
  /** @type {Line} */
  const line = {
    from,
    to: null,
    parts: ["back", "line"].map((name) => svgElement("line", { class: `wv-measure-${name}` })),
    ends: [0, 1].map(() => svgElement("circle", { class: "wv-measure-end", r: 4 })),
    label: el(
      "button",
      {
        type: "button",
        class: "wv-measure-label",
        "data-live": true,
        tabindex: -1,
        title: "Copy",
        onclick: () => copyLine(line),
      },
      length,
      steps,
    ),
    length,
    steps,
  };
  lines.push(line);
  drawing?.append(...line.parts, ...line.ends);
  layer?.element.append(line.label);
  return line;
}

/** @param {Line} line */
function remove(line) {
  if (line === open) open = null;
  lines.splice(lines.indexOf(line), 1);
  for (const part of [...line.parts, ...line.ends, line.label]) part.remove();
}

function removeAll() {
  while (lines.length) remove(lines[0]);
}

/** @param {Line} line */
async function copyLine(line) {
  const isCopied = await copy(words(line));
  if (isCopied) tell("ok", `Copied ${words(line)}.`);
  else tell("error", NOT_COPIED);
}

/** @param {Line} line one without an end has no length */
function parts({ from, to }) {
  const steps = (to ?? from).map((number, axis) => number - from[axis]);
  return [
    `${fixed(Math.hypot(...steps), 3)} m`,
    ["x", "y", "z"].map((axis, index) => `${axis} ${fixed(steps[index], 3)}`).join(" "),
  ];
}

/** @param {Line} line */
function words(line) {
  const [length, steps] = parts(line);
  return `${length} (${steps})`;
}

function draw() {
  if (!lines.length) return;
  layer?.place();
  for (const line of lines) drawLine(line);
}

/** @param {Line} line */
function drawLine(line) {
  const [from, to] = [onCanvas(line.from), onCanvas(line.to ?? line.from)];
  const seen = from && to && { x1: from[0], y1: from[1], x2: to[0], y2: to[1] };
  for (const part of line.parts) set(part, { display: seen ? null : "none", ...seen });
  [from, to].forEach((place, index) => {
    const end = place ? { display: null, cx: place[0], cy: place[1] } : { display: "none" };
    set(line.ends[index], end);
  });
  const isHidden = !seen || line.to === null;
  if (line.label.hidden !== isHidden) line.label.hidden = isHidden;
  if (!seen || isHidden) return;
  const [length, steps] = parts(line);
  setText(line.length, length);
  setText(line.steps, steps);
  const [x, y] = [(seen.x1 + seen.x2) / 2, (seen.y1 + seen.y2) / 2];
  const place = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, 10px)`;
  if (line.label.style.transform !== place) line.label.style.transform = place;
}
