// Views, as RViz has them, and their cameras; `webviz/api/views/` explains the numbers.
//
// A camera is `[position, lookAt]` in the coordinates of a target frame, whose z points up.

import constants from "../constants.js";
import { add, norm, scaled, sub } from "../vectors.js";

/** @import {Vec3} from "../types.js" */
/** @import {View, ViewCamera, ViewRig} from "./types.js" */

const { RAISED, EYE, FIELD_OF_VIEW, FLAT_FIELD_OF_VIEW } = constants;
const STEEPEST = 1.5698;
const TILT = 1e-5;
const NEAREST = 1e-3;
const REACH = 10;
const FARTHEST = 1000;
const MARGIN = 1.15;
const SMALLEST = 0.05;
const HALF = Math.PI / 2;

/** @param {number} yaw @param {number} pitch @returns {Vec3} */
const direction = (yaw, pitch) => [
  Math.cos(yaw) * Math.cos(pitch),
  Math.sin(yaw) * Math.cos(pitch),
  Math.sin(pitch),
];
/** @param {number} yaw @param {number} pitch */
const up = (yaw, pitch) => direction(yaw, pitch + HALF);
/** @param {number} angle */
const wrapped = (angle) => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
/** @param {number} value @param {number} low @param {number} high */
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

/** @type {Record<string, Partial<View>>} */
const DEFAULTS = {
  FPS: { yaw: 0, pitch: 0, position: [5, 5, 10] },
  TopDownOrtho: { scale: 10, angle: 0, x: 0, y: 0 },
};
const AROUND = { distance: 10, yaw: 0.785398, pitch: 0.785398, focal_point: [0, 0, 0] };

/**
 * The defaults of a type.
 *
 * @param {string} type
 * @param {string} target_frame
 * @returns {View}
 */
export const zeroView = (type, target_frame) => ({
  type,
  target_frame,
  .../** @type {Partial<View>} */ (DEFAULTS[type] ?? AROUND),
});

/**
 * @param {View} view
 * @param {number} height of the picture in pixels
 * @returns {ViewCamera}
 */
export function cameraOf(view, height) {
  const { yaw = 0, pitch = 0 } = view;
  if (view.type === "FPS") {
    const position = view.position ?? [0, 0, 0];
    return [position, sub(position, scaled(direction(yaw + Math.PI, pitch), EYE))];
  }
  if (view.type === "TopDownOrtho") {
    /** @type {Vec3} */
    const at = [view.x ?? 0, view.y ?? 0, 0];
    const distance = height / (view.scale ?? 10) / 2 / Math.tan(FLAT_FIELD_OF_VIEW / 2);
    const away = direction((view.angle ?? 0) - HALF, HALF - TILT);
    return [add(at, scaled(away, distance)), at];
  }
  const distance = view.distance ?? 10;
  const raised = view.type === "Orbit" ? 0 : RAISED * distance;
  const at = add(view.focal_point ?? [0, 0, 0], scaled(up(yaw, pitch), raised));
  return [add(at, scaled(direction(yaw, pitch), distance)), at];
}

/**
 * The view of a type that a camera shows.
 *
 * @param {string} type
 * @param {string} target_frame
 * @param {ViewCamera} camera
 * @param {number} height
 * @returns {View}
 */
export function viewOf(type, target_frame, [position, lookAt], height) {
  const offset = sub(position, lookAt);
  const distance = Math.max(norm(offset), 1e-9);
  const yaw = Math.atan2(offset[1], offset[0]);
  const slope = Math.asin(clamp(offset[2] / distance, -1, 1));
  const pitch = clamp(slope, -STEEPEST, STEEPEST);
  if (type === "FPS") return { type, target_frame, yaw: wrapped(yaw + Math.PI), pitch, position };
  if (type === "TopDownOrtho") {
    const scale = height / 2 / Math.tan(FLAT_FIELD_OF_VIEW / 2) / distance;
    const angle = wrapped(yaw + HALF);
    return {
      type,
      target_frame,
      scale: clamp(scale, 1e-5, 1e6),
      angle,
      x: lookAt[0],
      y: lookAt[1],
    };
  }
  const raised = type === "Orbit" ? 0 : RAISED * distance;
  const focal_point = sub(lookAt, scaled(up(yaw, pitch), raised));
  return { type, target_frame, distance, yaw, pitch, focal_point };
}

/** @param {Vec3} point @param {number} yaw @returns {Vec3} */
const turned = ([x, y, z], yaw) => [
  Math.cos(yaw) * x - Math.sin(yaw) * y,
  Math.sin(yaw) * x + Math.cos(yaw) * y,
  z,
];
/** @param {ViewRig} rig @param {ViewCamera} camera @returns {ViewCamera} */
const outward = ({ origin, yaw }, [a, b]) => [
  add(turned(a, yaw), origin),
  add(turned(b, yaw), origin),
];
/** @param {ViewRig} rig @param {ViewCamera} camera @returns {ViewCamera} */
const inward = ({ origin, yaw }, [a, b]) => [
  turned(sub(a, origin), -yaw),
  turned(sub(b, origin), -yaw),
];

/**
 * A perspective camera that shows nearly the same as a view and looks at its focal point.
 *
 * @param {View} view
 * @param {number} height
 * @returns {ViewCamera}
 */
function eyeOf(view, height) {
  const [position, lookAt] = cameraOf(view, height);
  const offset = sub(position, lookAt);
  const length = norm(offset);
  if (view.type === "TopDownOrtho") {
    const flatter = Math.tan(FLAT_FIELD_OF_VIEW / 2) / Math.tan(FIELD_OF_VIEW / 2);
    const back = direction((view.angle ?? 0) - HALF, STEEPEST);
    return [add(lookAt, scaled(back, length * flatter)), lookAt];
  }
  if (view.type === "FPS") {
    const forward = scaled(offset, -1 / length);
    const reach = Math.abs(forward[2]) > 1e-3 ? -position[2] / forward[2] : -1;
    return [
      position,
      add(position, scaled(forward, reach > 0 && reach < FARTHEST ? reach : REACH)),
    ];
  }
  return [position, lookAt];
}

/**
 * The view of a type that shows the same as a perspective camera.
 *
 * @param {string} type
 * @param {string} frame
 * @param {ViewCamera} eye
 * @param {number} height
 */
function fitted(type, frame, [position, lookAt], height) {
  const offset = sub(position, lookAt);
  const distance = norm(offset);
  const back = scaled(offset, 1 / distance);
  const level = Math.hypot(back[0], back[1]);
  if (type === "TopDownOrtho") {
    const yaw = level > 1e-6 ? Math.atan2(back[1], back[0]) : -HALF;
    const scale = height / 2 / Math.tan(FIELD_OF_VIEW / 2) / distance;
    const [x, y] = lookAt;
    return {
      type,
      target_frame: frame,
      scale: clamp(scale, 1e-5, 1e6),
      angle: wrapped(yaw + HALF),
      x,
      y,
    };
  }
  const raised = RAISED * level;
  if (type !== "FPS" && type !== "Orbit" && back[2] > 0.05 - raised) {
    // Along the line of projection to where the focal point lies on the ground.
    const step = (lookAt[2] - raised * distance) / (back[2] + raised);
    if (NEAREST * distance < distance + step && distance + step < FARTHEST)
      return viewOf(type, frame, [position, sub(lookAt, scaled(back, step))], height);
  }
  return viewOf(type, frame, [position, lookAt], height);
}

/**
 * A view of another type or target frame that shows nearly the same.
 *
 * @param {View} view
 * @param {ViewRig} rig of its target frame
 * @param {string} type
 * @param {string} frame
 * @param {ViewRig} newRig
 * @param {number} height
 * @returns {View}
 */
export function mimic(view, rig, type, frame, newRig, height) {
  if (view.type === type)
    return viewOf(type, frame, inward(newRig, outward(rig, cameraOf(view, height))), height);
  return fitted(type, frame, inward(newRig, outward(rig, eyeOf(view, height))), height);
}

/**
 * The view from the same direction that fits a box of the fixed frame.
 *
 * @param {View} view
 * @param {ViewRig} rig
 * @param {{low: Vec3, high: Vec3}} box
 * @param {{width: number, height: number}} size of the picture
 * @returns {View}
 */
export function focus(view, rig, { low, high }, { width, height }) {
  const radius = Math.max(norm(sub(high, low)) / 2, SMALLEST);
  const narrow = Math.atan(Math.tan(FIELD_OF_VIEW / 2) * Math.min(1, width / height));
  const [position, lookAt] = outward(rig, eyeOf(view, height));
  const offset = sub(position, lookAt);
  const at = scaled(add(low, high), 0.5);
  const distance = (MARGIN * radius) / Math.sin(narrow);
  const eye = add(at, scaled(offset, distance / norm(offset)));
  return fitted(view.type, view.target_frame, inward(rig, [eye, at]), height);
}
