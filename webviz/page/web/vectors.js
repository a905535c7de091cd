// Vectors `[x, y, z]`, unit quaternions `[w, x, y, z]`, and poses `{position, wxyz}`.

/** @import {Vec3, Wxyz} from "webviz/types.js" */

/**
 * @typedef {{position: Vec3, wxyz: Wxyz}} Pose
 * @typedef {{origin: Vec3, direction: Vec3}} Ray
 */

/**
 * @param {Vec3} a
 * @param {Vec3} b
 * @returns {Vec3}
 */
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
/**
 * @param {Vec3} a
 * @param {Vec3} b
 * @returns {Vec3}
 */
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/**
 * @param {Vec3} a
 * @param {number} factor
 * @returns {Vec3}
 */
export const scaled = (a, factor) => [a[0] * factor, a[1] * factor, a[2] * factor];
/**
 * @param {Vec3} a
 * @param {Vec3} b
 */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/**
 * @param {Vec3} a
 * @param {Vec3} b
 * @returns {Vec3}
 */
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
/** @param {Vec3} a */
export const norm = (a) => Math.hypot(...a);

/**
 * The quaternion product: first `b`, then `a`.
 * @param {Wxyz} a
 * @param {Wxyz} b
 * @returns {Wxyz}
 */
export const turnedBy = ([aw, ax, ay, az], [bw, bx, by, bz]) => [
  aw * bw - ax * bx - ay * by - az * bz,
  aw * bx + ax * bw + ay * bz - az * by,
  aw * by - ax * bz + ay * bw + az * bx,
  aw * bz + ax * by - ay * bx + az * bw,
];

/**
 * @param {Wxyz} wxyz
 * @returns {Wxyz}
 */
export const inverse = ([w, x, y, z]) => [w, -x, -y, -z];

/**
 * A vector turned by a quaternion.
 *
 * @param {Wxyz} wxyz
 * @param {Vec3} vector
 */
export function rotate(wxyz, vector) {
  const [w, ...axis] = wxyz;
  const twice = scaled(cross(axis, vector), 2);
  return add(add(vector, scaled(twice, w)), cross(axis, twice));
}

/**
 * The rotation about a unit vector by an angle in radians.
 *
 * @param {Vec3} axis
 * @param {number} angle
 * @returns {Wxyz}
 */
export const about = ([x, y, z], angle) => {
  const sine = Math.sin(angle / 2);
  return [Math.cos(angle / 2), x * sine, y * sine, z * sine];
};

/**
 * Of length one; rounding adds up over a long drag.
 *
 * @param {Wxyz} wxyz
 * @returns {Wxyz}
 */
export function unit([w, x, y, z]) {
  const length = Math.hypot(w, x, y, z);
  return [w / length, x / length, y / length, z / length];
}

/**
 * The pose of `b`, given relative to `a`.
 *
 * @param {Pose} a
 * @param {Pose} b
 * @returns {Pose}
 */
export const compose = (a, b) => ({
  position: add(a.position, rotate(a.wxyz, b.position)),
  wxyz: turnedBy(a.wxyz, b.wxyz),
});

/**
 * The angle by which `from` turns about a unit vector, perpendicular to both, to point like `to`, in radians.
 *
 * @param {Vec3} axis
 * @param {Vec3} from
 * @param {Vec3} to
 */
export const angleAbout = (axis, from, to) => Math.atan2(dot(axis, cross(from, to)), dot(from, to));

/**
 * Return where a ray `{origin, direction}` meets a plane, or null if that is behind it or very far.
 *
 * @param {Ray} ray
 * @param {Vec3} point
 * @param {Vec3} normal
 */
export function onPlane({ origin, direction }, point, normal) {
  const steps = dot(sub(point, origin), normal) / dot(direction, normal);
  return steps >= 0 && steps < 1e9 ? add(origin, scaled(direction, steps)) : null;
}

/**
 * The point of a line, through `point` along a unit vector, that is nearest to a ray, or null.
 *
 * @param {Ray} ray
 * @param {Vec3} point
 * @param {Vec3} axis
 */
export function onLine({ origin, direction }, point, axis) {
  const between = sub(point, origin);
  const cosine = dot(axis, direction);
  const square = 1 - cosine * cosine;
  if (square < 1e-9) return null;
  const along = (cosine * dot(direction, between) - dot(axis, between)) / square;
  return add(point, scaled(axis, along));
}
