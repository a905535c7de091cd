import assert from "node:assert/strict";
import { test } from "node:test";

import { frameAt, shownAt, within } from "../../webviz/page/web/recorded/moments.js";
import { changesBetween } from "../../webviz/page/web/recorded/scene_changes.js";

/** @import {Chunk, Known} from "webviz/recorded/types.js" */

/**
 * @param {number} number
 * @param {string} node
 * @returns {Known}
 */
const create = (number, node) => ({ number, node, key: `create:${node}`, phase: "create" });
/**
 * @param {number} number
 * @param {string} node
 * @returns {Known}
 */
const remove = (number, node) => ({ number, node, key: `create:${node}`, phase: "remove" });
/**
 * @param {number} number
 * @param {string} node
 * @param {string} key
 * @returns {Known}
 */
const change = (number, node, key) => ({ number, node, key: `${node}:${key}`, phase: "" });
const SCENE = [change(0, "", "background"), create(1, "/a"), create(2, "/a/b")];

test("what has not changed is not sent again", () => {
  assert.deepEqual(changesBetween(SCENE, SCENE), { gone: [], wanted: [] });
  const moved = [...SCENE, change(3, "/a", "position")];
  assert.deepEqual(changesBetween(SCENE, moved), { gone: [], wanted: [3] });
  const on = [...SCENE, change(4, "/a", "position")];
  assert.deepEqual(changesBetween(moved, on), { gone: [], wanted: [4] });
  assert.deepEqual(changesBetween(on, moved), { gone: [], wanted: [3] });
});

test("a node that was made anew gets all its changes again, and what is below it stays", () => {
  const before = [...SCENE, change(3, "/a", "position")];
  const anew = [SCENE[0], SCENE[2], create(5, "/a"), change(6, "/a", "position")];
  assert.deepEqual(changesBetween(before, anew), { gone: [], wanted: [5, 6] });
  assert.deepEqual(changesBetween(anew, before), { gone: [], wanted: [1, 3] });
});

test("back before a change, a node is made anew with all that is below it", () => {
  const later = [...SCENE, change(3, "/a", "position"), change(4, "/a/b", "color")];
  const before = [...SCENE, change(4, "/a/b", "color")];
  assert.deepEqual(changesBetween(later, before), { gone: ["/a"], wanted: [1, 2, 4] });
});

test("nodes that are not there yet, or any more, are removed", () => {
  assert.deepEqual(changesBetween(SCENE, SCENE.slice(0, 2)), { gone: ["/a/b"], wanted: [] });
  const removed = [...SCENE.slice(0, 2), remove(7, "/a/b")];
  assert.deepEqual(changesBetween(SCENE, removed), { gone: ["/a/b"], wanted: [] });
  assert.deepEqual(changesBetween(removed, SCENE), { gone: [], wanted: [2] });
});

/** @type {Pick<Chunk, "start" | "frames">} */
const CHUNK = {
  start: { scene: [0, 1], stores: { displays: { order: 0 } }, panes: { image: [0] } },
  frames: [
    [0, 10, [], [], [], []],
    [0.1, 10.1, [2], [0], [["displays", "a", 1]], [["image", []]]],
    [0.2, 10.2, [3], [2], [["displays", "order", -1]], [["image", [4, 5]]]],
  ],
};

test("each frame of a chunk is what its beginning and the changes up to it make", () => {
  const [first, second, third] = [0, 1, 2].map((frame) => shownAt(CHUNK, frame));
  assert.deepEqual([...first.scene], [0, 1]);
  assert.deepEqual([...second.scene], [1, 2]);
  assert.deepEqual([...third.scene], [1, 3]);
  assert.deepEqual(
    [...(second.stores.get("displays") ?? [])],
    [
      ["order", 0],
      ["a", 1],
    ],
  );
  assert.deepEqual([...(third.stores.get("displays") ?? [])], [["a", 1]]);
  assert.deepEqual([first.panes.get("image"), second.panes.has("image")], [[0], false]);
  assert.deepEqual(third.panes.get("image"), [4, 5]);
  assert.equal(third.ros, 10.2);
});

test("the frame of a time is the last one up to it", () => {
  const index = [{ times: [0, 0.1] }, { times: [0.2, 0.3, 0.4] }];
  /** @type {[number, [number, number]][]} */
  const moments = [
    [-1, [0, 0]],
    [0.15, [0, 1]],
    [0.2, [1, 0]],
    [0.39999999999, [1, 2]],
    [9, [1, 2]],
  ];
  for (const [at, wanted] of moments) assert.deepEqual(frameAt(index, at), wanted);
});

test("a group is a display with those that follow it and are deeper", () => {
  const depths = { a: 0, g: 0, b: 1, c: 2, d: 0 };
  /** @type {[string, unknown][]} */
  const displays = Object.entries(depths).map(([id, depth]) => [id, { depth }]);
  const rows = new Map([["order", Object.keys(depths)], ...displays]);
  assert.deepEqual(within(rows, "g"), ["g", "b", "c"]);
  assert.deepEqual(within(rows, "b"), ["b", "c"]);
  assert.deepEqual(within(rows, "d"), ["d"]);
  assert.deepEqual(within(new Map(), "d"), []);
});
