import assert from "node:assert/strict";
import { test } from "node:test";

import { bent, straight } from "../../webviz/page/web/images/undistort.js";

/** @import {Vec2} from "webviz/types.js" */

const [ROWS, COLUMNS] = [37, 49];

/**
 * A warp of a lens with barrel distortion; `sees(x, y)` says where it sees anything.
 *
 * @param {number} strength
 * @param {(x: number, y: number) => boolean} sees
 */
function warp(strength, sees = () => true) {
  /** @type {(number | null)[]} */
  const places = [];
  for (let row = 0; row < ROWS; row++) {
    for (let column = 0; column < COLUMNS; column++) {
      const [x, y] = [column / (COLUMNS - 1) - 0.5, row / (ROWS - 1) - 0.5];
      const scale = 1 - strength * (x * x + y * y);
      places.push(...(sees(x, y) ? [x * scale + 0.5, y * scale + 0.5] : [null, null]));
    }
  }
  return { rows: ROWS, columns: COLUMNS, places };
}

test("places of an image are found where the undistorted image shows them", () => {
  for (const strength of [0, 0.35, 0.6, -0.3]) {
    const lens = warp(strength);
    for (let i = 1; i < 20; i++) {
      /** @type {Vec2} */
      const place = [i / 20, ((i * 7) % 20) / 20];
      const share = straight(lens, place);
      if (!share) continue;
      const point = bent(lens, share);
      assert.ok(point, `${strength} ${share}`);
      assert.ok(
        Math.hypot(point[0] - place[0], point[1] - place[1]) < 1e-5,
        `${strength} ${place}`,
      );
    }
  }
});

test("points outside of a lens have no place, and invalid numbers do no harm", () => {
  const blind = warp(0.35, () => false);
  assert.equal(bent(blind, [0.5, 0.5]), null);
  const half = warp(0.35, (x) => x < 0);
  assert.ok(bent(half, [0.3, 0.5]));
  assert.equal(straight(half, [0.9, 0.5]), null);
  for (const bad of [NaN, Infinity, -1e308]) assert.equal(bent(half, [bad, 0.5]), null);
});
