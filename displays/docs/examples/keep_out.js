// The gesture "outline": a line drawn by hand on the ground.

import { set, svgElement } from "webviz/dom.js";

/** @import {Page} from "webviz/extensions.js" */
/** @import {SceneEvent, Vec2, Vec3} from "webviz/types.js" */

const STEP_PX = 10; // between two corners
const MAX_CORNERS = 500;

/** @param {Page} page */
export default function install({ beforeRender, canvas, gesture, groundAt, makeLayer, onCanvas }) {
  const line = svgElement("polyline", { fill: "none", stroke: "#f80", "stroke-width": 3 });
  const layer = makeLayer("keep-out", svgElement("svg", { width: "100%", height: "100%" }, line));
  /** @type {Vec3[]} */
  let corners = [];
  /** @type {Vec2 | null} */
  let last = null; // where the newest corner was drawn, in pixels

  const draw = () => {
    layer.place();
    set(line, { points: corners.map(onCanvas).filter(Boolean).join(" ") });
  };
  beforeRender(() => corners.length && draw()); // the view may move with a frame

  function clear() {
    corners = [];
    last = null;
    draw();
  }

  /** @param {SceneEvent} event */
  function add({ clientX, clientY }) {
    const isNear = last && Math.hypot(clientX - last[0], clientY - last[1]) < STEP_PX;
    const corner = isNear || corners.length >= MAX_CORNERS ? null : groundAt(clientX, clientY);
    if (!corner) return;
    last = [clientX, clientY];
    corners.push(corner);
    draw();
  }

  gesture("outline", (tool, finish) => ({
    hint: "Draw an outline on the ground. Esc cancels.",
    cursor: "crosshair",
    leave: clear,
    pointer(event) {
      if (event instanceof PointerEvent && event.type === "pointerdown" && event.button === 0) {
        canvas().setPointerCapture(event.pointerId);
        add(event);
        return true;
      }
      if (!corners.length) return false;
      if (event.type === "pointermove") add(event);
      if (event.type === "pointerup") finish({ points: corners });
      if (event.type === "pointerup" || event.type === "pointercancel") clear();
      return true;
    },
  }));
}
