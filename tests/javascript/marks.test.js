import assert from "node:assert/strict";
import { test } from "node:test";

import { markAt, zoomedPlaces } from "../../webviz/page/web/images/marks.js";

/** @import {Places} from "webviz/images/marks.js" */
/** @import {Mark} from "webviz/messages.js" */

/** @type {Places} */
const places = { at: (x, y) => [2 * x, 2 * y], scale: 2, width: 200 };
/**
 * @param {string} about
 * @param {number} left
 * @param {number} top
 * @param {number} right
 * @param {number} bottom
 * @returns {Mark}
 */
const box = (about, left, top, right, bottom) => ({
  kind: "loop",
  points: [left, top, right, top, right, bottom, left, bottom],
  color: "#ff0000",
  about,
});

test("the smallest box under the mouse is described, and nothing outside them all", () => {
  const marks = [box("dog", 20, 20, 30, 30), box("room", 0, 0, 90, 90), box("", 24, 24, 26, 26)];
  assert.equal(markAt(marks, places, [50, 50]), "dog");
  assert.equal(markAt(marks, places, [100, 100]), "room");
  assert.equal(markAt(marks, places, [100, 198]), "");
  assert.equal(markAt([], places, [0, 0]), "");
});

test("marks move with a picture that is zoomed", () => {
  const { at, scale, width } = zoomedPlaces(places, 3, [-0.5, -0.25], 80);
  assert.deepEqual([at(10, 10), scale, width], [[-40, 40], 6, 200]);
});
