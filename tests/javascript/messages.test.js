import assert from "node:assert/strict";
import { test } from "node:test";

import { rowsOf, textOf } from "../../webviz/page/web/panels/message_tree.js";
import { statisticsRows, statisticsText } from "../../webviz/features/selection/statistics.js";

/** @import {MessageRow} from "webviz/panels/message_tree.js" */

const stamp = { fields: { sec: "5", nanosec: "0" } };
const header = { fields: { stamp, frame_id: "'base'" } };
const numbers = { items: ["0.0", "1e+308"], length: 720, type: "" };
const poses = { items: [{ fields: { x: "nan" } }], length: 1, type: "geometry_msgs/Pose" };
const MESSAGE = {
  fields: { header, ranges: numbers, poses, none: { items: [], length: 0, type: "" } },
};

/** @param {MessageRow[]} rows */
const printed = (rows) =>
  rows.map(({ depth, name, value }) => `${"  ".repeat(depth)}${name} ${value}`.trimEnd());

test("messages are unfolded at first, and sequences are not", () => {
  const rows = rowsOf(MESSAGE, new Map());
  assert.deepEqual(printed(rows), [
    "header",
    "  stamp",
    "    sec 5",
    "    nanosec 0",
    "  frame_id 'base'",
    "ranges [0.0, 1e+308, …]  720 in all",
    "poses 1 × geometry_msgs/Pose",
    "none []",
  ]);
  assert.deepEqual(
    rows.map(({ isOpen }) => isOpen),
    [true, true, null, null, null, false, false, null],
  );
});

test("rows are folded by their keys, and omitted ones counted", () => {
  const folds = new Map([
    ["/header", false],
    ["/ranges", true],
    ["/poses", true],
    ["/poses/[0]", false],
  ]);
  assert.deepEqual(printed(rowsOf(MESSAGE, folds)), [
    "header stamp: sec: 5, nanosec: 0, frame_id: 'base'",
    "ranges 720 in all",
    "  [0] 0.0",
    "  [1] 1e+308",
    "   … 718 more",
    "poses 1 × geometry_msgs/Pose",
    "  [0] x: nan",
    "none []",
  ]);
});

test("messages deep within others are folded, and the line of a folded one is short", () => {
  const deep = {
    fields: { a: { fields: { b: { fields: { c: { fields: { d: "9".repeat(1e5) } } } } } } },
  };
  const rows = rowsOf(deep, new Map());
  assert.deepEqual(
    rows.map(({ name, isOpen }) => [name, isOpen]),
    [
      ["a", true],
      ["b", true],
      ["c", false],
    ],
  );
  const { value } = rows[rows.length - 1];
  assert.ok(value.length < 100 && value.endsWith("…"));
});

test("a message is copied as ros2 topic echo prints it, with omitted parts marked", () => {
  assert.equal(
    textOf(MESSAGE),
    [
      "header:",
      "  stamp:",
      "    sec: 5",
      "    nanosec: 0",
      "  frame_id: 'base'",
      "ranges: [0.0, 1e+308, …]  # 720 in all",
      "poses:",
      "- x: nan",
      "none: []",
    ].join("\n"),
  );
  const more = { fields: { poses: { ...poses, length: 3 } } };
  assert.equal(textOf(more), "poses:\n- x: nan\n# 3 × geometry_msgs/Pose");
});

test("sequences within sequences are copied in a line each", () => {
  const row = { items: ["1", "0"], length: 2, type: "" };
  const matrix = { fields: { pose: { items: [row, row], length: 2, type: "" } } };
  assert.equal(textOf(matrix), "pose:\n- [1, 0]\n- [1, 0]");
});

test("statistics have the digits that tell their values apart", () => {
  const range = { name: "x", unit: "m", low: 500_000.1234, high: 500_000.5678, mean: 500_000.3 };
  const [head, row] = statisticsRows([{ name: "Scan", count: 3, ranges: [range] }], new Map());
  assert.equal(head.value, "3 selected");
  assert.equal(row.value, "500000.123 to 500000.568, mean 500000.3 m");
  const tiny = { name: "y", unit: "", low: 1e-300, high: 2e-300, mean: 1.5e-300 };
  const alike = { name: "w", unit: "", low: 0.00123, high: 0.00123, mean: 0.00123 };
  const huge = { name: "z", unit: "", low: 1e308, high: 1e308, mean: 1e308 };
  assert.equal(
    statisticsText([{ name: "A", count: 1, ranges: [tiny, alike, huge] }]),
    "A: 1 selected\n  y: 0 to 0, mean 0\n  w: 0.00123 to 0.00123, mean 0.00123\n  z: 1e+308 to 1e+308, mean 1e+308\n",
  );
});

test("statistics are folded by display, and have nothing to fold without values", () => {
  const range = { name: "x", unit: "", low: 0, high: 1, mean: 0.5 };
  const displays = [
    { name: "A", count: 1, ranges: [range] },
    { name: "B", count: 2, ranges: [] },
  ];
  const rows = statisticsRows(displays, new Map([["statistics 0", false]]));
  assert.deepEqual(
    rows.map(({ name, isOpen }) => [name, isOpen]),
    [
      ["A", false],
      ["B", null],
    ],
  );
});

test("a number with a name is copied as a number", () => {
  const message = { fields: { status: "DISCHARGING (2)", text: "'FULL (4)'" } };
  assert.equal(textOf(message), "status: 2  # DISCHARGING\ntext: 'FULL (4)'");
});
