// Drags of the pose of a handle: RViz's rules, in the coordinates of its frame.
//
// `begin` takes where the drag begins, and returns what takes each step of it. Both get how the
// camera sees the frame, see `projection.js`; a step also gets the pointer: `{at, by, wheel, shift,
// ctrl}`, where it is in the window, by how many pixels it has moved and by how many notches the
// wheel. A step returns `{position, wxyz, turned}`, or null where the pointer means nothing.

import {
  about,
  add,
  angleAbout,
  dot,
  norm,
  onLine,
  onPlane,
  rotate,
  scaled,
  sub,
  turnedBy,
  unit,
} from "webviz/vectors.js";

/** @import {HandleControl} from "webviz/contents.js" */
/** @import {Pose} from "webviz/vectors.js" */
/** @import {Projection} from "webviz/scene/projection.js" */
/** @import {Vec2, Vec3} from "webviz/types.js" */

/**
 * @typedef {Pose & {turned: number}} Moved
 * @typedef {Pick<HandleControl, "mode" | "facing" | "wxyz">} Control
 * @typedef {Pick<Projection, "rayAt" | "project" | "perPixel" | "unit" | "right" | "up" | "forward">} View
 * @typedef {{
 *   control: Control, pose: Pose, turned: number, grab: Vec3, projection: View, at: Vec2,
 * }} Start
 * @typedef {Start & {axis: Vec3}} Axial
 * @typedef {{at: Vec2, by: Vec2, wheel: number, shift: boolean, ctrl: boolean}} Pointer
 * @typedef {(pointer: Pointer, projection: View) => Partial<Moved> | null} Step
 */

/** @type {Vec3} */
const X = [1, 0, 0];
const TURN = (2 * Math.PI) / 300; // radians per pixel
const WHEEL_PX = 20; // that a notch of the wheel stands for

/**
 * Begins a drag of a control.
 *
 * `start`: `{control, pose, turned, grab, projection, at}`; `pose` is that of the handle, `turned` the
 * angle by which the control has been turned so far, `grab` the point that is dragged.
 *
 * @param {Start} start
 * @returns {(pointer: Pointer, projection: View) => Moved | null}
 */
export function begin(start) {
  const axis = axisOf(start);
  /** @type {Partial<Record<Control["mode"], (start: Axial) => Step>>} */
  const factories = {
    move_axis: alongAxis,
    move_plane: inPlane,
    rotate_axis: aroundAxis,
    move_rotate: towed,
    move_3d: freely,
    rotate_3d: freely,
    move_rotate_3d: freely,
  };
  const step = factories[start.control.mode]?.({ ...start, axis });
  return (pointer, projection) => {
    const moved = step?.(pointer, projection);
    return moved ? { ...start.pose, turned: start.turned, ...moved } : null;
  };
}

/**
 * The x axis of a control, along which it moves, or about which it turns.
 *
 * @param {Pick<Start, "control" | "pose" | "projection">} start
 */
export function axisOf({ control, pose, projection }) {
  if (control.facing === "view_facing") return projection.forward;
  const own = rotate(control.wxyz, X);
  return control.facing === "fixed" ? own : rotate(pose.wxyz, own);
}

/**
 * The point of the axis that is next to the pointer on the screen.
 *
 * @param {Axial} start
 * @returns {Step}
 */
function alongAxis({ pose, grab, axis }) {
  return ({ at }, projection) => {
    const from = projection.project(grab);
    const to = projection.project(add(grab, scaled(axis, projection.unit(grab))));
    if (!from || !to) return null;
    const [x, y] = from;
    const [dx, dy] = [to[0] - x, to[1] - y];
    const square = dx * dx + dy * dy;
    if (square < 1e-6) return null; // it points to the camera
    const along = ((at[0] - x) * dx + (at[1] - y) * dy) / square;
    const point = onLine(projection.rayAt([x + along * dx, y + along * dy]), grab, axis);
    return point && { position: add(pose.position, sub(point, grab)) };
  };
}

/**
 * @param {Axial} start
 * @returns {Step}
 */
function inPlane({ pose, grab, axis }) {
  return ({ at }, projection) => {
    const hit = onPlane(projection.rayAt(at), grab, axis);
    return hit && { position: add(pose.position, sub(hit, grab)) };
  };
}

/**
 * @param {Axial} start
 * @returns {Step}
 */
function aroundAxis({ pose, turned, grab, axis }) {
  const out = sub(grab, pose.position);
  const middle = add(pose.position, scaled(axis, dot(out, axis)));
  return ({ at }, projection) => {
    const hit = onPlane(projection.rayAt(at), middle, axis);
    if (!hit) return null;
    const angle = angleAbout(axis, sub(grab, middle), sub(hit, middle));
    return { wxyz: unit(turnedBy(about(axis, angle), pose.wxyz)), turned: turned + angle };
  };
}

/**
 * As if towed by a rope of constant length: it turns towards the pointer, and follows it.
 *
 * @param {Axial} start
 * @returns {Step}
 */
function towed({ pose, turned, grab, axis }) {
  let [{ position, wxyz }, handle, angle] = [pose, grab, turned];
  return ({ at }, projection) => {
    const out = sub(handle, position);
    const middle = add(position, scaled(axis, dot(out, axis)));
    const hit = onPlane(projection.rayAt(at), middle, axis);
    if (!hit) return null;
    const [before, now] = [sub(handle, middle), sub(hit, middle)];
    if (norm(now) < 1e-9) return null;
    const step = angleAbout(axis, before, now);
    angle += step;
    wxyz = unit(turnedBy(about(axis, step), wxyz));
    position = add(position, scaled(now, 1 - norm(before) / norm(now)));
    handle = hit;
    return { position, wxyz, turned: angle };
  };
}

/**
 * Moves in the plane of the screen, or turns like a ball; with Shift in depth, or like a wheel.
 *
 * @param {Axial} start
 * @returns {Step}
 */
function freely({ control, pose, grab, projection, at }) {
  let { position, wxyz } = pose;
  const away = projection.rayAt(at).direction;
  /** @type {{from: Vec3 | null, base: Vec3, point: Vec3} | null} */
  let slide = null; // in the plane of the screen, since the keys mean that
  return ({ at, by, wheel, shift, ctrl }, projection) => {
    const dragged = add(grab, sub(position, pose.position));
    if (control.mode === "rotate_3d" || (control.mode === "move_rotate_3d" && ctrl)) {
      wxyz = unit(turnedBy(spin(by, shift, projection), wxyz));
    } else if (shift || wheel) {
      const [dx, dy] = shift ? by : [0, 0];
      const up = Math.abs(dx) > Math.abs(dy) ? dx : -dy;
      const pixels = up - wheel * WHEEL_PX;
      position = add(position, scaled(away, pixels * projection.perPixel(dragged)));
    } else {
      /** @param {Vec2} xy */
      const on = (xy) => onPlane(projection.rayAt(xy), dragged, projection.forward);
      slide ??= { from: on([at[0] - by[0], at[1] - by[1]]), base: position, point: dragged };
      const hit = onPlane(projection.rayAt(at), slide.point, projection.forward);
      if (!hit || !slide.from) return null;
      position = add(slide.base, sub(hit, slide.from));
      return { position, wxyz };
    }
    slide = null;
    return { position, wxyz };
  };
}

/**
 * @param {Vec2} by
 * @param {boolean} shift
 * @param {View} projection
 */
function spin([dx, dy], shift, { up, right, forward }) {
  if (shift) return about(forward, dx * TURN);
  return turnedBy(about(up, dx * TURN), about(right, dy * TURN));
}
