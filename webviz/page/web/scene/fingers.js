// Two fingers on the scene: what is between them stays there, so that it grows as they move apart.
//
// One finger turns the view, as the left button does. viser's own two fingers zoom by a share of the
// pixels that depends on the rate of the events.

import { isLocked, move, slides, slide, walk, zoom } from "webviz/scene/mouse.js";
import * as views from "webviz/scene/view.js";
import * as viser from "webviz/viser_page.js";

/** @import {Vec2} from "webviz/types.js" */

const FPS_STEP = 0.02; // metres for a pixel

/** @type {Map<number, Vec2>} */
const fingers = new Map();

export function install() {
  const events = viser.canvas().parentElement;
  const { touches } = viser.controls();
  touches.two = touches.three = viser.actions().NONE;
  events.addEventListener("pointerdown", ({ pointerId, pointerType, clientX, clientY }) => {
    if (pointerType === "touch") fingers.set(pointerId, [clientX, clientY]);
  });
  window.addEventListener("pointermove", take);
  for (const name of /** @type {const} */ (["pointerup", "pointercancel"]))
    window.addEventListener(name, ({ pointerId }) => fingers.delete(pointerId), true);
}

/** @param {PointerEvent} event */
function take({ pointerId, clientX, clientY }) {
  if (!fingers.has(pointerId)) return;
  const before = [...fingers.values()];
  fingers.set(pointerId, [clientX, clientY]);
  if (fingers.size !== 2 || isLocked() || !viser.controls().enabled) return;
  const after = [...fingers.values()];
  const [from, to] = [middle(before), middle(after)];
  if (slides()) slide(from, to);
  else move([to[0] - from[0], to[1] - from[1]]);
  if (views.isFPS()) walk(FPS_STEP * (apart(after) - apart(before)));
  else zoom(apart(before) / apart(after));
}

/**
 * @param {Vec2[]} points
 * @returns {Vec2}
 */
const middle = ([a, b]) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];

/**
 * Their distance, at least a pixel.
 *
 * @param {Vec2[]} points
 */
const apart = ([a, b]) => Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1]));
