import assert from "node:assert/strict";
import { test } from "node:test";

import {
  STANDARD,
  focused,
  moved,
  sightOf,
  turned,
  zoomed,
} from "../../webviz/panels/scene_view_camera.js";
import { add, rotate, scaled } from "../../webviz/page/web/vectors.js";

/** @import {Vec2} from "webviz/types.js" */
/** @import {SceneCamera} from "../../webviz/panels/scene_view_camera.js" */

/** @type {Vec2} */
const SIZE = [400, 200];
/**
 * @param {number[]} a
 * @param {number[]} b
 */
const near = (a, b) => a.forEach((x, i) => assert.ok(Math.abs(x - b[i]) < 1e-9, `${a} ~ ${b}`));
/** @type {SceneCamera} */
const above = { ...STANDARD, type: "TopDownOrtho", yaw: -Math.PI / 2 };

test("an orbit has its distance from the focal point, by yaw and pitch", () => {
  /** @type {SceneCamera} */
  const camera = { ...STANDARD, focal_point: [1, 2, 3], distance: 2, yaw: 0, pitch: Math.PI / 6 };
  near(sightOf(camera, SIZE).position, [1 + Math.sqrt(3), 2, 4]);
});

test("it looks at its focal point, without a roll", () => {
  for (const [yaw, pitch] of [
    [0, 0],
    [2, 0.5],
    [-2.5, -1],
    [0.3, 1.5],
  ]) {
    const { position, wxyz } = sightOf({ ...STANDARD, yaw, pitch }, SIZE);
    near(add(position, scaled(rotate(wxyz, [0, 0, 1]), STANDARD.distance)), [0, 0, 0]);
    near([rotate(wxyz, [1, 0, 0])[2]], [0]);
    assert.ok(rotate(wxyz, [0, 1, 0])[2] < 0);
  }
});

test("the view from the top has north up, and shows as much at any height of the picture", () => {
  const { position, edges, flat } = sightOf(above, SIZE);
  near(position.slice(0, 2), [0, 0]);
  near(
    [edges[1] * flat, edges[2] * flat],
    [20 * Math.tan(Math.PI / 8), 10 * Math.tan(Math.PI / 8)],
  );
});

test("a drag keeps the point under the pointer, and a double click focuses it", () => {
  const meter = SIZE[1] / (2 * above.distance * Math.tan(Math.PI / 8));
  near(moved(above, [meter, 2 * meter], SIZE[1]).focal_point, [-1, 2, 0]);
  near(focused(above, [200 + meter, 100 - 2 * meter], SIZE).focal_point, [1, 2, 0]);
  near(focused(STANDARD, [200, 100], SIZE).focal_point, [0, 0, 0]);
  const level = { ...STANDARD, pitch: 0 };
  assert.equal(focused(level, [200, 50], SIZE), level, "nothing is above the horizon");
});

test("it turns by 5 mrad a pixel but not over the top, and keeps a distance", () => {
  near([turned(STANDARD, [100, 0]).yaw], [STANDARD.yaw - 0.5]);
  assert.equal(turned(STANDARD, [0, 1e4]).pitch, 1.5698);
  assert.equal(zoomed(STANDARD, 2).distance, 20);
  assert.equal(zoomed(STANDARD, 0).distance, 0.01);
});
