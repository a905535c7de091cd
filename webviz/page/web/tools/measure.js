// The tool that measures between points of surfaces. Its lines stay where they are in the fixed
// frame.

import { copy } from "../clipboard.js";
import { el, set, setText, svgElement } from "../dom.js";
import { onCanvas, surfaceAt } from "../scene/ground.js";
import { watch } from "../stores.js";
import * as viser from "../viser_page.js";
import { clicks } from "./clicks.js";
import { tell, tellLive } from "./hint.js";
import { makeLayer } from "./layer.js";
import { fixed } from "./numbers.js";

const MAX_LINES = 50;
const MAX_WAIT_MS = 250; // between looks at what is below the pointer
const HINT = "Click on two points. Right click clears, Esc leaves.";

const lines = [];
let open = null; // the line that has no end yet
let layer = null;
let drawing = null;
let pointer = null;
let isWaiting = false;
let frame = null;

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

function press(event) {
  const point = surfaceAt([event.clientX, event.clientY]);
  if (point === null) return tell("warn", "Nothing is there. Click on a surface or on the ground.");
  if (open) {
    open.to = point;
    finish();
  } else {
    if (lines.length >= MAX_LINES) remove(lines[0]);
    open = makeLine(point);
  }
  viser.requestRender();
}

function finish() {
  set(open.label, { "data-live": null, tabindex: 0 });
  open = null;
  tellLive("");
}

// A right click gives up the line that has no end, or clears all.
function clear() {
  if (open) remove(open);
  else removeAll();
  tellLive("");
}

// A ray through a large cloud takes long: the next one waits as long as four of them.
function move(event) {
  pointer = [event.clientX, event.clientY];
  if (open && !isWaiting) requestAnimationFrame(look);
  isWaiting ||= open !== null;
}

function look() {
  const [before, at] = [performance.now(), pointer];
  const point = open && at && surfaceAt(at);
  if (point) {
    open.to = point;
    tellLive(words(open));
    draw();
  }
  const next = () => {
    isWaiting = open !== null && pointer !== at;
    if (isWaiting) requestAnimationFrame(look);
  };
  setTimeout(next, Math.min(4 * (performance.now() - before), MAX_WAIT_MS));
}

function makeLine(from) {
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
      el("b"),
      el("span"),
    ),
  };
  lines.push(line);
  drawing.append(...line.parts, ...line.ends);
  layer.element.append(line.label);
  return line;
}

function remove(line) {
  if (line === open) open = null;
  lines.splice(lines.indexOf(line), 1);
  for (const part of [...line.parts, ...line.ends, line.label]) part.remove();
}

function removeAll() {
  while (lines.length) remove(lines[0]);
}

async function copyLine(line) {
  const isCopied = await copy(words(line));
  if (isCopied) tell("ok", `Copied ${words(line)}.`);
  else tell("error", "The browser does not allow copying.");
}

function parts({ from, to }) {
  const steps = to.map((number, axis) => number - from[axis]);
  return [
    `${fixed(Math.hypot(...steps), 3)} m`,
    ["x", "y", "z"].map((axis, index) => `${axis} ${fixed(steps[index], 3)}`).join(" "),
  ];
}

function words(line) {
  const [length, steps] = parts(line);
  return `${length} (${steps})`;
}

function draw() {
  if (!lines.length) return;
  layer.place();
  for (const line of lines) drawLine(line);
}

function drawLine(line) {
  const ends = [line.from, line.to ?? line.from].map(onCanvas);
  const isSeen = !ends.includes(null);
  for (const part of line.parts) {
    set(part, { display: isSeen ? null : "none" });
    if (isSeen) set(part, { x1: ends[0][0], y1: ends[0][1], x2: ends[1][0], y2: ends[1][1] });
  }
  line.ends.forEach((end, index) => {
    set(end, { display: ends[index] ? null : "none" });
    if (ends[index]) set(end, { cx: ends[index][0], cy: ends[index][1] });
  });
  const isHidden = !isSeen || line.to === null;
  if (line.label.hidden !== isHidden) line.label.hidden = isHidden;
  if (isHidden) return;
  const [length, steps] = parts(line);
  setText(line.label.firstChild, length);
  setText(line.label.lastChild, steps);
  const [x, y] = [0, 1].map((axis) => (ends[0][axis] + ends[1][axis]) / 2);
  const place = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, 10px)`;
  if (line.label.style.transform !== place) line.label.style.transform = place;
}
