import assert from "node:assert/strict";
import { test } from "node:test";

import {
  about,
  angleAbout,
  compose,
  inverse,
  onLine,
  onPlane,
  rotate,
  turnedBy,
  unit,
} from "../../webviz/page/web/vectors.js";

/** @import {Vec3} from "webviz/types.js" */
/** @import {Pose, Ray} from "webviz/vectors.js" */

/** @type {Vec3[]} */
const [X, Y, Z] = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];
/** @type {Ray} */
const DOWN = { origin: [2, 3, 10], direction: [0, 0, -1] };

/**
 * @param {number[] | null} found
 * @param {number[]} wanted
 */
function near(found, wanted) {
  assert.ok(found);
  assert.equal(found.length, wanted.length);
  found.forEach((value, i) =>
    assert.ok(Math.abs(value - wanted[i]) < 1e-12, `${found}, not ${wanted}`),
  );
}

test("a quaternion turns counter-clockwise about its axis", () => {
  near(rotate(about(Z, Math.PI / 2), X), Y);
  near(rotate(about(X, Math.PI / 2), Y), Z);
  near(rotate(about(Y, Math.PI / 2), Z), X);
  near(rotate([1, 0, 0, 0], [1e300, -2, 0]), [1e300, -2, 0]);
});

test("a product of quaternions turns by the second first", () => {
  const both = turnedBy(about(Z, Math.PI / 2), about(X, Math.PI / 2));
  near(rotate(both, Y), Z);
  near(rotate(both, X), Y);
  near(turnedBy([0, 0, 1, 0], [0, 0, 0, 1]), [0, 1, 0, 0]);
  near(turnedBy(both, inverse(both)), [1, 0, 0, 0]);
});

test("poses are composed in the frame of the first", () => {
  /** @type {Pose} */
  const a = { position: [1, 0, 0], wxyz: about(Z, Math.PI / 2) };
  const { position, wxyz } = compose(a, { position: [2, 0, 0], wxyz: about(Z, Math.PI / 2) });
  near(position, [1, 2, 0]);
  near(rotate(wxyz, X), [-1, 0, 0]);
});

test("a quaternion is made of length one", () => {
  near(unit([0, 3, 0, 4]), [0, 0.6, 0, 0.8]);
  near(unit([1e200, 0, 0, 1e200]), [Math.SQRT1_2, 0, 0, Math.SQRT1_2]);
});

test("an angle about an axis has the sign of the right hand", () => {
  near([angleAbout(Z, X, Y), angleAbout(Z, Y, X)], [Math.PI / 2, -Math.PI / 2]);
  near([angleAbout(Z, [5, 0, 0], [-2, 0, 0])], [Math.PI]);
});

test("a ray meets a plane in front of it only", () => {
  near(onPlane(DOWN, [0, 0, 4], Z), [2, 3, 4]);
  assert.equal(onPlane(DOWN, [0, 0, 11], Z), null, "behind");
  assert.equal(onPlane(DOWN, [0, 0, 4], X), null, "parallel");
  assert.equal(
    onPlane({ origin: [0, 0, 1], direction: [1, 0, -1e-12] }, [0, 0, 0], Z),
    null,
    "far",
  );
  assert.equal(onPlane(DOWN, [0, 0, NaN], Z), null);
});

test("the nearest point of a line to a ray lies on the line, also behind its origin", () => {
  near(onLine(DOWN, [0, 0, 0], X), [2, 0, 0]);
  near(onLine({ origin: [-7, 1, 5], direction: [0, 0, -1] }, [1, 0, 0], X), [-7, 0, 0]);
  assert.equal(onLine(DOWN, [0, 0, 0], Z), null, "parallel");
});
