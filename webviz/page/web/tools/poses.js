// Poses over the scene, with numbers: waypoints that are collected, and where robots drive to.

import { set, setText, svgElement } from "webviz/dom.js";
import { onCanvas } from "webviz/scene/ground.js";
import * as viser from "webviz/viser_page.js";
import { arrowAt } from "webviz/tools/arrow.js";
import { makeLayer } from "webviz/tools/layer.js";

/** @import {Vec3} from "webviz/types.js" */

/** @typedef {{point: Vec3, yaw: number, number: string}} Pose */

const ARROW = 0.5; // of that of a gesture

/**
 * A layer that shows poses: `show([{point, yaw, number}])`, in metres and radians in the fixed frame;
 * `number` is a text or "".
 *
 * @param {string} name
 */
export function makePoses(name) {
  /** @type {ReturnType<typeof makeLayer> | null} */
  let layer = null;
  /** @type {SVGSVGElement | null} */
  let drawing = null;
  /** @type {ReturnType<typeof makeMark>[]} */
  let marks = [];
  /** @type {Pose[]} */
  let current = [];

  function draw() {
    if (!current.length) return;
    layer?.place();
    current.forEach((pose, index) => drawPose(marks[index], pose));
  }

  function begin() {
    const svg = svgElement("svg");
    layer = makeLayer(name, svg);
    viser.beforeRender(draw);
    return svg;
  }

  return function show(/** @type {Pose[]} */ poses) {
    if (!poses.length && !current.length) return;
    drawing ??= begin();
    current = poses;
    for (const mark of marks.splice(poses.length)) mark.group.remove();
    while (marks.length < poses.length) {
      const mark = makeMark();
      marks.push(mark);
      drawing.append(mark.group);
    }
    poses.forEach(({ number }, index) => {
      setText(marks[index].number, number);
      set(marks[index].dot, { r: number ? 9 : 4 });
    });
    viser.requestRender();
    draw();
  };
}

function makeMark() {
  const arrow = svgElement("polygon", { class: "wv-pose-arrow" });
  const dot = svgElement("circle", { class: "wv-pose-start" });
  const number = svgElement("text", { class: "wv-pose-number" });
  return { arrow, dot, number, group: svgElement("g", {}, arrow, dot, number) };
}

/**
 * @param {ReturnType<typeof makeMark>} mark
 * @param {Pose} pose
 */
function drawPose({ arrow, dot, number, group }, { point, yaw }) {
  const start = onCanvas(point);
  const corners = start && arrowAt(point, yaw, ARROW);
  set(group, { display: corners ? null : "none" });
  if (!corners) return;
  set(arrow, { points: corners.join(" ") });
  set(dot, { cx: start[0], cy: start[1] });
  set(number, { x: start[0], y: start[1] });
}
