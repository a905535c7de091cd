// Vectors `[x, y, z]`, unit quaternions `[w, x, y, z]`, and poses `{position, wxyz}`.

/**
 * @typedef {[number, number, number]} Vector
 * @typedef {[number, number, number, number]} Quaternion
 */

export const add = (a, b) => a.map((value, axis) => value + b[axis]);
export const sub = (a, b) => a.map((value, axis) => value - b[axis]);
export const scaled = (a, factor) => a.map((value) => value * factor);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const norm = (a) => Math.hypot(...a);

/**
 * The quaternion product: first `b`, then `a`.
 *
 * @type {(a: Quaternion, b: Quaternion) => Quaternion}
 */
export const turnedBy = ([aw, ax, ay, az], [bw, bx, by, bz]) => [
  aw * bw - ax * bx - ay * by - az * bz,
  aw * bx + ax * bw + ay * bz - az * by,
  aw * by - ax * bz + ay * bw + az * bx,
  aw * bz + ax * by - ay * bx + az * bw,
];

export const inverse = ([w, x, y, z]) => [w, -x, -y, -z];

/** A vector turned by a quaternion. */
export function rotate(wxyz, vector) {
  const [, ...axis] = wxyz;
  const twice = scaled(cross(axis, vector), 2);
  return add(add(vector, scaled(twice, wxyz[0])), cross(axis, twice));
}

/**
 * The rotation about a unit vector by an angle in radians.
 *
 * @type {(axis: Vector, angle: number) => Quaternion}
 */
export const about = ([x, y, z], angle) => {
  const sine = Math.sin(angle / 2);
  return [Math.cos(angle / 2), x * sine, y * sine, z * sine];
};

/**
 * Of length one; rounding adds up over a long drag.
 *
 * @type {(wxyz: Quaternion) => Quaternion}
 */
export function unit([w, x, y, z]) {
  const length = Math.hypot(w, x, y, z);
  return [w / length, x / length, y / length, z / length];
}

/** The pose of `b`, given relative to `a`. */
export const compose = (a, b) => ({
  position: add(a.position, rotate(a.wxyz, b.position)),
  wxyz: turnedBy(a.wxyz, b.wxyz),
});

/** The angle by which `from` turns about a unit vector, perpendicular to both, to point like `to`, in radians. */
export const angleAbout = (axis, from, to) => Math.atan2(dot(axis, cross(from, to)), dot(from, to));

/** Where a ray `{origin, direction}` meets a plane, or null if that is behind it or very far. */
export function onPlane({ origin, direction }, point, normal) {
  const steps = dot(sub(point, origin), normal) / dot(direction, normal);
  return steps >= 0 && steps < 1e9 ? add(origin, scaled(direction, steps)) : null;
}

/** The point of a line, through `point` along a unit vector, that is nearest to a ray, or null. */
export function onLine({ origin, direction }, point, axis) {
  const between = sub(point, origin);
  const cosine = dot(axis, direction);
  const square = 1 - cosine * cosine;
  if (square < 1e-9) return null;
  const along = (cosine * dot(direction, between) - dot(axis, between)) / square;
  return add(point, scaled(axis, along));
}
