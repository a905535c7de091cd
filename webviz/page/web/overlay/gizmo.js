// The axes of the fixed frame as the camera sees them; a click on an end looks from there.

import { svgElement } from "webviz/dom.js";
import * as views from "webviz/scene/view.js";
import * as viser from "webviz/viser_page.js";

/** @import {Vec3} from "webviz/types.js" */

const SIZE = 84;
const REACH = 28;
/** @type {[string, number, number][]} */
const ENDS = [
  ["X", 0, 1],
  ["Y", 1, 1],
  ["Z", 2, 1],
  ["-X", 0, -1],
  ["-Y", 1, -1],
  ["-Z", 2, -1],
];

export function build() {
  const drawing = svgElement("svg", {
    class: "wv-gizmo",
    viewBox: `${-SIZE / 2} ${-SIZE / 2} ${SIZE} ${SIZE}`,
    width: SIZE,
    height: SIZE,
    role: "group",
    "aria-label": "Axes of the fixed frame",
  });
  const ends = ENDS.map(([label, axis, sign]) => {
    /** @type {Vec3} */
    const xyz = [0, 0, 0];
    xyz[axis] = sign;
    const look = () =>
      views.type() !== "TopDownOrtho" && !views.options().lock_camera && views.lookFrom(xyz);
    /** @param {KeyboardEvent} event */
    const onKey = (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      look();
    };
    const line = svgElement("line", { class: "wv-gizmo-line" });
    const ball = svgElement("circle", { r: sign > 0 ? 9 : 6 });
    const name = svgElement("text", {}, sign > 0 ? label : "");
    const title = svgElement("title", {}, `Look from ${label}`);
    const group = svgElement(
      "g",
      {
        "data-axis": "xyz"[axis],
        "data-side": sign > 0 ? "front" : "back",
        role: "button",
        tabindex: 0,
        "aria-label": `Look from ${label}`,
        onclick: look,
        onkeydown: onKey,
      },
      line,
      ball,
      name,
      title,
    );
    return { group, line, ball, name, axis, sign };
  });
  drawing.append(...ends.map(({ group }) => group));

  let shown = "";
  viser.beforeRender(() => {
    const axes = views.axes();
    const now = axes
      .flat()
      .map((number) => number.toFixed(2))
      .join();
    if (now === shown) return;
    shown = now;
    const order = ends.map((end) => ({ end, depth: end.sign * axes[end.axis][2] }));
    order.sort((a, b) => a.depth - b.depth);
    for (const { end, depth } of order) {
      const [x, y] = axes[end.axis].map((number) => number * REACH * end.sign);
      const place = { x2: x.toFixed(1), y2: (-y).toFixed(1) };
      for (const [key, value] of Object.entries(place)) end.line.setAttribute(key, value);
      end.ball.setAttribute("cx", place.x2);
      end.ball.setAttribute("cy", place.y2);
      end.name.setAttribute("x", place.x2);
      end.name.setAttribute("y", place.y2);
      end.group.style.opacity = depth < -0.3 ? "0.55" : "1";
    }
    // In the order of their depth; not under the mouse, where it would lose a click.
    if (drawing.matches(":hover") || drawing.contains(document.activeElement)) return;
    drawing.append(...order.map(({ end }) => end.group));
  });
  return drawing;
}
