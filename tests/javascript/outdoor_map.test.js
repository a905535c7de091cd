import assert from "node:assert/strict";
import { test } from "node:test";

import {
  mercator,
  pixelOf,
  placeAt,
  tilesOf,
  unmercator,
  zoomed,
} from "../../webviz/panels/outdoor_mercator.js";

const SIZE = { width: 600, height: 400 };

test("places are shares of the world in Web Mercator, and back", () => {
  assert.deepEqual(mercator([0, 0]), [0.5, 0.5]);
  const [x, y] = mercator([-180, 85.0511287798066]);
  assert.ok(x === 0 && Math.abs(y) < 1e-9);
  const [longitude, latitude] = unmercator(mercator([8.25, 49.5]));
  assert.ok(Math.abs(longitude - 8.25) < 1e-9 && Math.abs(latitude - 49.5) < 1e-9);
});

test("a map requests visible tiles from the middle outwards, and none beyond the world", () => {
  const [first, ...rest] = tilesOf({ x: 0.6, y: 0.3, zoom: 3.2 }, SIZE);
  assert.deepEqual(first, [3, 4, 2]);
  assert.ok(rest.length >= 3 && rest.length < 12);
  assert.deepEqual(tilesOf({ x: 0.5, y: 0.5, zoom: 0 }, { width: 3000, height: 3000 }), [
    [0, 0, 0],
  ]);
  assert.deepEqual(tilesOf({ x: 5, y: 5, zoom: 4 }, SIZE), []);
});

test("zooming a map keeps the point under the pointer and stops at the last level", () => {
  const look = { x: 0.5, y: 0.25, zoom: 4 };
  assert.deepEqual(pixelOf([0.5, 0.25], look, SIZE), [300, 200]);
  const place = placeAt([100, 50], look, SIZE);
  const near = zoomed(look, 1.5, [100, 50], SIZE);
  assert.equal(near.zoom, 5.5);
  const pixel = pixelOf(place, near, SIZE);
  assert.ok(Math.hypot(pixel[0] - 100, pixel[1] - 50) < 1e-6, String(pixel));
  assert.equal(zoomed(look, 99, [0, 0], SIZE).zoom, 21);
  assert.equal(zoomed(look, -99, [0, 0], SIZE).zoom, 1);
});
