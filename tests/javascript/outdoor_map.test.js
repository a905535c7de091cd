import assert from "node:assert/strict";
import { test } from "node:test";

import { mercator, tilesOf, unmercator } from "../../webviz/panels/outdoor_map.js";

test("places are shares of the world in Web Mercator, and back", () => {
  assert.deepEqual(mercator([0, 0]), [0.5, 0.5]);
  const [x, y] = mercator([-180, 85.0511287798066]);
  assert.ok(x === 0 && Math.abs(y) < 1e-9);
  const [longitude, latitude] = unmercator(mercator([8.25, 49.5]));
  assert.ok(Math.abs(longitude - 8.25) < 1e-9 && Math.abs(latitude - 49.5) < 1e-9);
});

test("a map asks for what is in sight, its middle first, and for nothing beyond the world", () => {
  const [first, ...rest] = tilesOf({ x: 0.6, y: 0.3, zoom: 3.2 }, 600, 400);
  assert.deepEqual(first, [3, 4, 2]);
  assert.ok(rest.length >= 3 && rest.length < 12);
  assert.deepEqual(tilesOf({ x: 0.5, y: 0.5, zoom: 0 }, 3000, 3000), [[0, 0, 0]]);
  assert.deepEqual(tilesOf({ x: 5, y: 5, zoom: 4 }, 300, 300), []);
});
