// The tool that measures between points of surfaces. Its lines stay where they are in the fixed
// frame.

import { NOT_COPIED, copy } from "webviz/clipboard.js";
import { el, set, setText, svgElement } from "webviz/dom.js";
import { onCanvas, surfaceAt } from "webviz/scene/ground.js";
import * as viser from "webviz/viser_page.js";
import { clicks } from "webviz/tools/clicks.js";
import { onFrameChange } from "webviz/tools/frame_change.js";
import { showHint, showLiveHint } from "webviz/tools/hint.js";
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

/**
 * The tool.
 *
 * @returns {Tool}
 */
export function measure() {
  /** @type {Ruler | null} */
  let ruler = null;
  return {
    id: "measure",
    name: "Measure",
    shortcut: "n",
    icon: "ruler",
    order: 4,
    isLean: true,
    hint: HINT,
    tooltip: "Measure between points.",
    cursor: "crosshair",
    pointer: clicks(
      (event) => ruler?.press(event),
      () => ruler?.clear(),
      (event) => ruler?.move(event),
    ),
    select: () => void (ruler ??= new Ruler()),
    leave: () => ruler?.leave(),
  };
}

/** All lines of a page, from when this is made. */
class Ruler {
  /** @type {Line[]} */
  #lines = [];
  /** @type {Line | null} */
  #open = null; // the line that has no end yet
  #drawing = svgElement("svg");
  #layer = makeLayer("measure", this.#drawing);
  /** @type {Vec2 | null} */
  #pointer = null;
  #isWaiting = false;

  constructor() {
    viser.beforeRender(() => this.#draw());
    onFrameChange(() => this.#removeAll());
  }

  leave() {
    this.#pointer = null;
    if (this.#open) this.#remove(this.#open);
  }

  /** @param {PointerEvent} event */
  press(event) {
    const point = surfaceAt([event.clientX, event.clientY]);
    if (point === null)
      return showHint("warn", "Nothing is there. Click on a surface or on the ground.");
    if (this.#open) {
      this.#open.to = point;
      this.#finish(this.#open);
    } else {
      if (this.#lines.length >= MAX_LINES) this.#remove(this.#lines[0]);
      this.#open = this.#begin(point);
    }
    viser.requestRender();
  }

  /** A right click gives up the line that has no end, or clears all. */
  clear() {
    if (this.#open) this.#remove(this.#open);
    else this.#removeAll();
    showLiveHint("");
  }

  /**
   * A ray through a large cloud takes long: the next one waits as long as four of them.
   *
   * @param {PointerEvent} event
   */
  move(event) {
    this.#pointer = [event.clientX, event.clientY];
    if (this.#open && !this.#isWaiting) requestAnimationFrame(() => this.#look());
    this.#isWaiting ||= this.#open !== null;
  }

  #look() {
    const [before, at, line] = [performance.now(), this.#pointer, this.#open];
    const point = line && at && surfaceAt(at);
    if (point) {
      line.to = point;
      showLiveHint(words(line));
      this.#draw();
    }
    const next = () => {
      this.#isWaiting = this.#open !== null && this.#pointer !== at;
      if (this.#isWaiting) requestAnimationFrame(() => this.#look());
    };
    setTimeout(next, Math.min(4 * (performance.now() - before), MAX_WAIT_MS));
  }

  /** @param {Vec3} from */
  #begin(from) {
    const line = makeLine(from);
    this.#lines.push(line);
    this.#drawing.append(...line.parts, ...line.ends);
    this.#layer.element.append(line.label);
    return line;
  }

  /** @param {Line} line */
  #finish(line) {
    set(line.label, { "data-live": null, tabindex: 0 });
    this.#open = null;
    showLiveHint("");
  }

  /** @param {Line} line */
  #remove(line) {
    if (line === this.#open) this.#open = null;
    this.#lines.splice(this.#lines.indexOf(line), 1);
    for (const part of [...line.parts, ...line.ends, line.label]) part.remove();
  }

  #removeAll() {
    while (this.#lines.length) this.#remove(this.#lines[0]);
  }

  #draw() {
    if (!this.#lines.length) return;
    this.#layer.place();
    for (const line of this.#lines) drawLine(line);
  }
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
  return line;
}

/** @param {Line} line */
async function copyLine(line) {
  const isCopied = await copy(words(line));
  if (isCopied) showHint("ok", `Copied ${words(line)}.`);
  else showHint("error", NOT_COPIED);
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

/** @param {Line} line */
function drawLine(line) {
  const [from, to] = [onCanvas(line.from), onCanvas(line.to ?? line.from)];
  const segment = from && to && { x1: from[0], y1: from[1], x2: to[0], y2: to[1] };
  for (const part of line.parts) set(part, { display: segment ? null : "none", ...segment });
  [from, to].forEach((place, index) => {
    const end = place ? { display: null, cx: place[0], cy: place[1] } : { display: "none" };
    set(line.ends[index], end);
  });
  const isHidden = !segment || line.to === null;
  if (line.label.hidden !== isHidden) line.label.hidden = isHidden;
  if (!segment || isHidden) return;
  const [length, steps] = parts(line);
  setText(line.length, length);
  setText(line.steps, steps);
  const [x, y] = [(segment.x1 + segment.x2) / 2, (segment.y1 + segment.y2) / 2];
  const place = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, 10px)`;
  if (line.label.style.transform !== place) line.label.style.transform = place;
}
