// Control of the camera by mouse and keyboard, as in RViz.
//
// Left turns, middle or left with shift moves, right and the wheel come closer. F looks at what is
// under the mouse.

import { command } from "webviz/commands.js";
import { shortcuts } from "webviz/keys.js";
import constants from "webviz/constants.js";
import { pickAt } from "webviz/scene/picking/pick.js";
import { casterAt } from "webviz/scene/rays.js";
import * as views from "webviz/scene/view.js";
import * as viser from "webviz/viser_page.js";

/** @import {Vector3} from "three" */
/** @import {Hit, Vec2} from "webviz/types.js" */

const { EYE, FIELD_OF_VIEW } = constants;
const MAX_SLIDE = 1; // metres

// Seen to below, and by viser's camera.
shortcuts("Scene", [
  { does: "Turn the view", keys: ["Drag"] },
  { does: "Move the view", keys: ["Shift+Drag", "Middle button"] },
  { does: "Zoom", keys: ["Wheel", "Right button"] },
  { does: "Walk", keys: ["w", "a", "s", "d"] },
  { does: "Down, up", keys: ["q", "e"] },
  { does: "Turn", keys: ["ArrowLeft", "ArrowUp", "ArrowRight", "ArrowDown"] },
]);

/** True for a view whose camera stays where it is in its frame. */
export const isLocked = () => Boolean(views.options().lock_camera);
/** True for views that move over the ground. */
export const slides = () => ["XYOrbit", "ThirdPersonFollower"].includes(views.type());

/** @param {MouseEvent} [event] */
function arm(event) {
  const controls = viser.controls();
  const ACTION = viser.actions();
  const buttons = controls.mouseButtons;
  const move = slides() ? ACTION.NONE : ACTION.TRUCK;
  buttons.left = event && event.shiftKey ? move : ACTION.ROTATE;
  buttons.middle = move;
  buttons.right = buttons.wheel = ACTION.NONE;
  controls.enabled = !isLocked();
  // RViz turns a view by 5 mrad/px, and moves FPS by 1 cm/px.
  const tall = viser.canvas().clientHeight;
  controls.azimuthRotateSpeed = controls.polarRotateSpeed = (0.005 * tall) / (2 * Math.PI);
  controls.truckSpeed = views.isFPS() ? (0.01 * tall) / (EYE * Math.tan(FIELD_OF_VIEW / 2)) : 2;
}

/**
 * Keeps the point of the ground under the mouse, as RViz's XYOrbit, but moves at most a metre for an
 * event, because the ground is far away near the horizon.
 *
 * @param {Vec2} from
 * @param {Vec2} to
 */
export function slide(from, to) {
  const [before, now] = [from, to].map(groundOfView);
  if (!before || !now) return;
  const controls = viser.controls();
  const at = controls.getTarget(before.clone()).add(before.sub(now).clampLength(0, MAX_SLIDE));
  controls.moveTo(...at.toArray(), false);
}

// In the coordinates of the camera's controls, which may follow a frame.
/** @param {Vec2} xy */
function groundOfView(xy) {
  const { ray } = casterAt(xy);
  const { origin, direction } = ray.applyMatrix4(views.followed().clone().invert());
  const steps = -origin.y / direction.y;
  return steps > 0 ? origin.addScaledVector(direction, steps) : null;
}

/**
 * Goes ahead.
 *
 * @param {number} meters
 */
export function walk(meters) {
  const controls = viser.controls();
  const eye = controls.getPosition(viser.camera().position.clone());
  const at = controls.getTarget(eye.clone());
  const step = at.clone().sub(eye).setLength(meters);
  controls.setLookAt(...eye.add(step).toArray(), ...at.add(step).toArray(), false);
}

/**
 * Moves what is at the distance of the focal point with the pointer; RViz moves FPS by 1 cm/px.
 *
 * @param {Vec2} by pixels
 */
export function move([dx, dy]) {
  const meters = views.isFPS() ? 0.01 : views.metersPerPixel();
  viser.controls().truck(-dx * meters, -dy * meters, false);
}

/**
 * Goes away by a factor: RViz by 1 % for a pixel down, and by 12 % for a notch of the wheel.
 *
 * @param {number} factor of the distance
 */
export function zoom(factor) {
  const controls = viser.controls();
  const distance = controls.distance * factor;
  const { minDistance, maxDistance } = controls;
  controls.dollyTo(Math.min(Math.max(distance, minDistance), maxDistance), false);
}

/** @param {WheelEvent} event */
function notches({ deltaY, deltaMode }) {
  return deltaMode === WheelEvent.DOM_DELTA_LINE ? deltaY / 3 : deltaY / 120;
}

// The nearest thing under a point of the window, see `pickAt`; on the ground a place in three.js'
// coordinates without an `object`, above the horizon null.
/**
 * @param {Vec2} xy
 * @returns {Hit | null}
 */
export function hit(xy) {
  const target = pickAt(xy);
  if (target) return target;
  const { origin, direction } = casterAt(xy).ray;
  const steps = -origin.y / direction.y;
  if (!(steps > 0 && steps < 1e6)) return null;
  return { point: origin.addScaledVector(direction, steps), object: null };
}

/**
 * The place under a point of the window, in three.js' coordinates, or null.
 *
 * @param {Vec2} xy
 */
export const pick = (xy) => hit(xy)?.point ?? null;

/**
 * Looks at what is under a point of the window; at nothing, in that direction, as RViz does.
 *
 * @param {Vec2} xy
 */
export function focusOn(xy) {
  const target = pick(xy);
  if (target) return focus(target);
  const { origin, direction } = casterAt(xy).ray;
  focus(origin.addScaledVector(direction, 1));
}

/**
 * Looks at a point, as RViz does: turns the camera, and moves a view that cannot turn.
 *
 * @param {Vector3} point
 */
export function focus(point) {
  if (isLocked()) return;
  const controls = viser.controls();
  const at = point.applyMatrix4(views.followed().clone().invert());
  if (slides() || views.type() === "TopDownOrtho") {
    at.add(views.raised());
    controls.moveTo(at.x, at.y, at.z, slides());
  } else if (views.isFPS()) {
    const eye = controls.getPosition(at.clone());
    at.sub(eye).setLength(EYE).add(eye);
    controls.setLookAt(eye.x, eye.y, eye.z, at.x, at.y, at.z, true);
  } else {
    controls.setTarget(at.x, at.y, at.z, true);
  }
}

export function install() {
  const events = viser.canvas().parentElement;
  /** @type {Vec2 | null} */
  let mouse = null;
  let isSliding = false;
  /** @param {MouseEvent} [event] */
  const begin = (event) => {
    arm(event);
    isSliding = slides() && (event?.button === 1 || (event?.button === 0 && event.shiftKey));
  };
  window.addEventListener("pointerdown", begin, true);
  events.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault(); // else the browser enlarges its page with Ctrl, or by a pinch
      if (isLocked()) return;
      const steps = notches(event);
      if (views.isFPS()) walk(-1.2 * steps);
      else zoom(Math.pow(steps > 0 ? 1.12 : 1 / 0.88, steps));
    },
    { passive: false },
  );
  events.addEventListener("pointermove", (event) => {
    const before = mouse;
    mouse = [event.clientX, event.clientY];
    if (event.buttons === 0) isSliding = false;
    if (isSliding && before) slide(before, mouse);
    if (isLocked() || event.buttons !== 2 || event.pointerType === "touch") return;
    if (views.isFPS()) walk(-0.1 * event.movementY);
    else zoom(Math.pow(1.01, event.movementY));
  });
  events.addEventListener("pointerleave", () => (mouse = null));
  command({
    name: "Look at what is under the mouse",
    key: "f",
    group: "Scene",
    isHidden: true,
    isThere: () => mouse !== null,
    run: () => {
      const point = mouse && pick(mouse);
      if (point) focus(point);
    },
  });
  views.onShow(() => begin());
  begin();
}
