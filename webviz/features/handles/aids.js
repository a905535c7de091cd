// The axis along which, or about which, a handle is dragged.

import { set, svgElement } from "webviz/dom.js";
import { computed, effect, owned, signal } from "webviz/signals.js";
import { makeLayer } from "webviz/tools/layer.js";
import { beforeRender } from "webviz/viser_page.js";
import { projectionOf } from "webviz/scene/projection.js";
import { add, scaled } from "webviz/vectors.js";

/** @import {HandleControl} from "webviz/contents.js" */
/** @import {Projection} from "webviz/scene/projection.js" */
/** @import {SceneObject, Vec2, Vec3} from "webviz/types.js" */

/** @typedef {{object: SceneObject, point: Vec3, axis: Vec3}} Line */

const REACH_PX = 4000; // to either side
const STEPS = 40; // to find where it goes behind the camera

const current = signal(/** @type {Line | null} */ (null));

export function install() {
  const isShown = computed(() => current.value !== null);
  /** @type {ReturnType<typeof makeAxis> | null} */
  let axis = null;
  effect(() => {
    const next = isShown.value ? makeAxis() : null;
    axis = next;
    owned(() => next?.layer.element.remove());
  });
  beforeRender(() => {
    if (axis && current.value) draw(axis, current.value);
  });
}

function makeAxis() {
  const line = svgElement("line", { class: "wv-handle-axis" });
  return { line, layer: makeLayer("axis", svgElement("svg", {}, line)) };
}

/**
 * True for a mode whose control has an axis to show.
 *
 * @param {HandleControl["mode"]} mode
 */
export const isAbout = (mode) => ["move_axis", "move_rotate", "rotate_axis"].includes(mode);

/**
 * Shows a line through a point of a frame, the coordinates of `object`; null for none.
 *
 * @param {Line | null} line
 */
export function show(line) {
  current.value = line;
}

/**
 * @param {ReturnType<typeof makeAxis>} axis
 * @param {Line} target
 */
function draw({ line, layer }, target) {
  layer.place();
  const projection = projectionOf(target.object);
  const [from, to] = [end(projection, target, -1), end(projection, target, 1)];
  const { left, top } = layer.element.getBoundingClientRect();
  if (!from || !to) return set(line, { visibility: "hidden" });
  const [start, stop] = [from, to].map(([x, y]) => [x - left, y - top]);
  const place = { x1: start[0], y1: start[1], x2: stop[0], y2: stop[1] };
  set(line, { visibility: "visible", ...place });
}

/**
 * As far as it goes on this side, and is in front of the camera.
 *
 * @param {Projection} projection
 * @param {Line} line
 * @param {number} side
 * @returns {Vec2 | null}
 */
function end(projection, { point, axis }, side) {
  const whole = (REACH_PX / 100) * projection.unit(point);
  for (let step = STEPS; step >= 0; step--) {
    const at = projection.project(add(point, scaled(axis, (side * whole * step) / STEPS)));
    if (at) return at;
  }
  return null;
}
