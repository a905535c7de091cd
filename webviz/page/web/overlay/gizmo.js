// The axes of the fixed frame as the camera sees them; a click on an end looks from there.

import { set, svgElement } from "webviz/dom.js";
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
  const ends = ENDS.map(([label, axis, sign]) => makeEnd(label, axis, sign));
  const drawing = svgElement(
    "svg",
    {
      class: "wv-gizmo",
      viewBox: `${-SIZE / 2} ${-SIZE / 2} ${SIZE} ${SIZE}`,
      width: SIZE,
      height: SIZE,
      role: "group",
      "aria-label": "Axes of the fixed frame",
    },
    ...ends.map(({ group }) => group),
  );
  let previous = "";
  viser.beforeRender(() => {
    const axes = views.axes();
    const now = axes
      .flat()
      .map((number) => number.toFixed(2))
      .join();
    if (now === previous) return;
    previous = now;
    const order = ends.map((end) => ({ end, depth: end.sign * axes[end.axis][2] }));
    order.sort((a, b) => a.depth - b.depth);
    for (const { end, depth } of order) place(end, axes[end.axis], depth);
    // In the order of their depth; not under the mouse, where it would lose a click.
    if (drawing.matches(":hover") || drawing.contains(document.activeElement)) return;
    drawing.append(...order.map(({ end }) => end.group));
  });
  return drawing;
}

/**
 * An end of an axis, a button that looks from there.
 *
 * @param {string} label
 * @param {number} axis
 * @param {number} sign
 */
function makeEnd(label, axis, sign) {
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
    svgElement("title", {}, `Look from ${label}`),
  );
  return { group, line, ball, name, axis, sign };
}

/**
 * @param {ReturnType<typeof makeEnd>} end
 * @param {Vec3} direction of the axis as the camera sees it
 * @param {number} depth towards the camera
 */
function place({ group, line, ball, name, sign }, direction, depth) {
  const [x, y] = direction.map((number) => number * REACH * sign);
  const [across, down] = [x.toFixed(1), (-y).toFixed(1)];
  set(line, { x2: across, y2: down });
  set(ball, { cx: across, cy: down });
  set(name, { x: across, y: down });
  group.style.opacity = depth < -0.3 ? "0.55" : "1";
}
