import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateSync } from "node:zlib";

import { cellAt, cellDetails, indexAt } from "../../webviz/page/web/recorded/cells.js";
import { columnDetails } from "../../webviz/page/web/recorded/columns.js";
import { frameAt, shownAt, within } from "../../webviz/page/web/recorded/moments.js";
import { changesBetween } from "../../webviz/page/web/recorded/scene_changes.js";

const create = (number, node) => ({ number, node, key: `create:${node}`, phase: "create" });
const remove = (number, node) => ({ number, node, key: `create:${node}`, phase: "remove" });
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
    [...second.stores.get("displays")],
    [
      ["order", 0],
      ["a", 1],
    ],
  );
  assert.deepEqual([...third.stores.get("displays")], [["a", 1]]);
  assert.deepEqual([first.panes.get("image"), second.panes.has("image")], [[0], false]);
  assert.deepEqual(third.panes.get("image"), [4, 5]);
  assert.equal(third.ros, 10.2);
});

test("the frame of a time is the last one up to it", () => {
  const index = [{ times: [0, 0.1] }, { times: [0.2, 0.3, 0.4] }];
  for (const [at, wanted] of [
    [-1, [0, 0]],
    [0.15, [0, 1]],
    [0.2, [1, 0]],
    [0.39999999999, [1, 2]],
    [9, [1, 2]],
  ])
    assert.deepEqual(frameAt(index, at), wanted);
});

/**
 * A PNG with a palette and rows that are not filtered, as webviz writes them.
 *
 * @param {number[][]} rows
 */
function png(rows) {
  const chunk = (kind, data) => {
    const head = Buffer.alloc(8);
    head.writeUInt32BE(data.length);
    head.write(kind, 4);
    return Buffer.concat([head, data, Buffer.alloc(4)]); // the checksum is not verified
  };
  const header = Buffer.alloc(13);
  header.writeUInt32BE(rows[0].length, 0);
  header.writeUInt32BE(rows.length, 4);
  header.set([8, 3], 8);
  const data = deflateSync(Buffer.from(rows.flatMap((row) => [0, ...row])));
  const parts = [data.subarray(0, 5), data.subarray(5)].map((part) => chunk("IDAT", part));
  const start = Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]);
  const palette = chunk("PLTE", Buffer.alloc(768));
  return new Uint8Array(Buffer.concat([start, chunk("IHDR", header), palette, ...parts]));
}

test("the cells of a map are the indices of its picture", async () => {
  const picture = png([
    [0, 100, 255],
    [7, 8, 9],
  ]);
  assert.equal(await indexAt(picture, 2, 0), 255);
  assert.equal(await indexAt(picture, 1, 1), 8);
  for (const [x, y] of [
    [3, 0],
    [-1, 0],
    [0, 2],
    [0, -1],
  ])
    assert.equal(await indexAt(picture, x, y), null);
  picture[25] = 6; // true colours
  assert.equal(await indexAt(picture, 0, 0), null);
});

test("a cell has the place in the whole map, also if that is turned", () => {
  const grid = {
    corner: [512, 1024],
    columns: 2000,
    resolution: 0.05,
    origin: [1, 2, 0],
    axes: [
      [0, 1, 0],
      [-1, 0, 0],
    ],
    frame: "map",
    told: Array.from({ length: 256 }, (_, index) => (index === 100 ? "100, occupied" : index)),
  };
  const cell = cellAt(grid, [0.12, 0.01, 0]);
  assert.deepEqual(cell, { x: 2, y: 0, column: 1026, row: 512 });
  const { title, fields } = cellDetails(grid, cell, 100);
  assert.equal(title, "Cell 1026, 512");
  assert.deepEqual(fields, {
    Value: "100, occupied",
    "Column (x)": "1026",
    "Row (y)": "512",
    Index: "1025026",
    "Centre in map": "-24.6250, 53.3250, 0.0000 m",
    Resolution: "0.05 m",
  });
});

test("a point of a large cloud has the values that a viewer shows", () => {
  const columns = {
    title: "Point {}",
    values: [
      ["intensity", { array: Float32Array.of(0, 0.1, 67), text: "{}" }],
      ["rgb", { array: Uint8Array.of(0, 0, 0, 1, 2, 3, 4, 5, 6), text: "r {}, g {}, b {}" }],
      ["Angle", { array: Float64Array.of(0, 0, NaN, 5.73, -Infinity, 2), text: "{} rad, {}°" }],
      ["Points in the cloud", "9"],
    ],
    ids: Uint16Array.of(3, 5, 8),
    position: "Position in lidar",
    origin: [100, 0, 0],
  };
  assert.deepEqual(columnDetails(columns, 1, [1, 2, 3]), {
    title: "Point 5",
    fields: [
      ["intensity", "0.1"],
      ["rgb", "r 1, g 2, b 3"],
      ["Angle", "nan rad, 5.73°"],
      ["Points in the cloud", "9"],
      ["Position in lidar", "101.0000, 2.0000, 3.0000 m"],
    ],
  });
  assert.deepEqual(columnDetails(columns, 2, [0, 0, 0]).fields.slice(0, 3), [
    ["intensity", "67.0"],
    ["rgb", "r 4, g 5, b 6"],
    ["Angle", "-inf rad, 2.0°"],
  ]);
  const leftOut = [["intensity", { array: new Float32Array(0), text: "{}" }]];
  assert.equal(columnDetails({ ...columns, values: leftOut }, 1, [0, 0, 0]), null);
});

test("a group is a display with those that follow it and are deeper", () => {
  const depths = { a: 0, g: 0, b: 1, c: 2, d: 0 };
  const rows = new Map([
    ["order", Object.keys(depths)],
    ...Object.entries(depths).map(([id, depth]) => [id, { depth }]),
  ]);
  assert.deepEqual(within(rows, "g"), ["g", "b", "c"]);
  assert.deepEqual(within(rows, "b"), ["b", "c"]);
  assert.deepEqual(within(rows, "d"), ["d"]);
  assert.deepEqual(within(new Map(), "d"), []);
});
