// The axis along which, or about which, a handle is dragged.

import { svgElement } from "../dom.js";
import { makeLayer } from "../tools/layer.js";
import { beforeRender } from "../viser_page.js";
import { sightOf } from "./sight.js";
import { add, scaled } from "./vectors.js";

const REACH_PX = 4000; // to either side
const STEPS = 40; // to find where it goes behind the camera

let shown = null;
let layer = null;
let line = null;

export function install() {
  beforeRender(draw);
}

/** True for a mode whose control has an axis to show. */
export const isAbout = (mode) => ["move_axis", "move_rotate", "rotate_axis"].includes(mode);

/** Shows a line through a point of a frame, the coordinates of `object`; null for none. */
export function show(object, point, axis) {
  shown = object && { object, point, axis };
  if (!shown) layer?.element.remove();
  if (!shown) layer = null;
}

function draw() {
  if (!shown) return;
  if (!layer) {
    line = svgElement("line", { class: "wv-handle-axis" });
    layer = makeLayer("axis", svgElement("svg", {}, line));
  }
  layer.place();
  const sight = sightOf(shown.object);
  const ends = [-1, 1].map((side) => end(sight, side));
  const { left, top } = layer.element.getBoundingClientRect();
  if (ends.includes(null)) return line.setAttribute("visibility", "hidden");
  line.setAttribute("visibility", "visible");
  ends.forEach(([x, y], index) => {
    line.setAttribute(`x${index + 1}`, x - left);
    line.setAttribute(`y${index + 1}`, y - top);
  });
}

// As far as it goes on this side, and is in front of the camera.
function end(sight, side) {
  const whole = (REACH_PX / 100) * sight.unit(shown.point);
  for (let step = STEPS; step >= 0; step--) {
    const at = sight.project(add(shown.point, scaled(shown.axis, (side * whole * step) / STEPS)));
    if (at) return at;
  }
  return null;
}
