import assert from "node:assert/strict";
import { test } from "node:test";

import { frameAt, shownAt, within } from "../../webviz/page/web/recorded/moments.js";
import { changesBetween } from "../../webviz/page/web/recorded/scene_changes.js";

/** @import {Chunk, MessageFacts} from "webviz/recorded/types.js" */

/**
 * @param {number} number
 * @param {string} node
 * @returns {MessageFacts}
 */
const create = (number, node) => ({ number, node, key: `create:${node}`, phase: "create" });
/**
 * @param {number} number
 * @param {string} node
 * @returns {MessageFacts}
 */
const remove = (number, node) => ({ number, node, key: `create:${node}`, phase: "remove" });
/**
 * @param {number} number
 * @param {string} node
 * @param {string} key
 * @returns {MessageFacts}
 */
const change = (number, node, key) => ({ number, node, key: `${node}:${key}`, phase: "" });
const SCENE = [change(0, "", "background"), create(1, "/a"), create(2, "/a/b")];

test("unchanged nodes are not sent again", () => {
  assert.deepEqual(changesBetween(SCENE, SCENE), { deletions: [], updates: [] });
  const moved = [...SCENE, change(3, "/a", "position")];
  assert.deepEqual(changesBetween(SCENE, moved), { deletions: [], updates: [3] });
  const on = [...SCENE, change(4, "/a", "position")];
  assert.deepEqual(changesBetween(moved, on), { deletions: [], updates: [4] });
  assert.deepEqual(changesBetween(on, moved), { deletions: [], updates: [3] });
});

test("a recreated node gets all its changes again, and its children stay", () => {
  const before = [...SCENE, change(3, "/a", "position")];
  const anew = [SCENE[0], SCENE[2], create(5, "/a"), change(6, "/a", "position")];
  assert.deepEqual(changesBetween(before, anew), { deletions: [], updates: [5, 6] });
  assert.deepEqual(changesBetween(anew, before), { deletions: [], updates: [1, 3] });
});

test("seeking back before a change recreates a node with its children", () => {
  const later = [...SCENE, change(3, "/a", "position"), change(4, "/a/b", "color")];
  const before = [...SCENE, change(4, "/a/b", "color")];
  assert.deepEqual(changesBetween(later, before), { deletions: ["/a"], updates: [1, 2, 4] });
});

test("nodes that are not there yet, or any more, are removed", () => {
  assert.deepEqual(changesBetween(SCENE, SCENE.slice(0, 2)), { deletions: ["/a/b"], updates: [] });
  const removed = [...SCENE.slice(0, 2), remove(7, "/a/b")];
  assert.deepEqual(changesBetween(SCENE, removed), { deletions: ["/a/b"], updates: [] });
  assert.deepEqual(changesBetween(removed, SCENE), { deletions: [], updates: [2] });
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

test("each frame of a chunk is its start with all changes up to it", () => {
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
