import assert from "node:assert/strict";
import { test } from "node:test";

import { foldable, layOut } from "../../webviz/panels/graph_layout.js";
import {
  boxAt,
  centred,
  finder,
  foldsOf,
  rateText,
  sumText,
  whole,
  zoomed,
} from "../../webviz/panels/graph_view.js";

/** @import {Box, Drawing, Topic} from "../../webviz/panels/graph_layout.js" */

/**
 * @param {string} name
 * @param {string[]} from
 * @param {string[]} to
 * @returns {Topic}
 */
const topic = (name, from, to) => ({ name, type: "T", from, to: to.map((node) => [node, ""]) });
const CHAIN = [
  topic("/scan", ["/driver"], ["/amcl"]),
  topic("/pose", ["/amcl"], ["/planner"]),
  topic("/cmd", ["/planner"], ["/driver"]),
];
/**
 * @param {Drawing} drawing
 * @param {string} key
 */
const layerOf = ({ boxes }, key) => boxes.get(key)?.layer ?? NaN;
/**
 * A box with what a test says of it.
 *
 * @param {Partial<Box>} said
 * @returns {Box}
 */
const boxOf = (said) => ({
  key: "",
  kind: "node",
  name: "",
  about: "",
  topics: [],
  layer: 0,
  x: 0,
  y: 0,
  width: 0,
  ...said,
});

test("links lead to the right, apart from one of a loop", () => {
  const drawing = layOut(CHAIN, () => false);
  assert.equal(drawing.boxes.size, 6);
  const back = drawing.links.filter(({ from, to }) => from.layer >= to.layer);
  assert.equal(back.length, 1);
  assert.equal(layerOf(drawing, "topic /pose"), layerOf(drawing, "node /amcl") + 1);
});

test("a folded namespace is one box, whose links are those of all in it", () => {
  const topics = [
    topic("/a/x", ["/a/one"], ["/sink"]),
    topic("/a/y", ["/a/two"], ["/sink", "/a/one"]),
  ];
  topics[1].to[0][1] = "It does not arrive.";
  assert.deepEqual([...foldable(topics)], ["/a"]);
  const { boxes, links } = layOut(topics, () => true);
  assert.deepEqual([...boxes.keys()].sort(), ["group /a", "node /sink"]);
  assert.equal(links.length, 1);
  assert.equal(links[0].why, "It does not arrive.");
  assert.equal(links[0].topics.size, 2);
});

test("boxes do not overlap, with names of any length", () => {
  const hostile = ["", "/", "//", "no slash", "/x".repeat(100), "__proto__"];
  const topics = hostile.map((name) => topic(name, hostile, hostile));
  const all = [...layOut(topics, () => false).boxes.values()];
  assert.equal(all.length, 2 * hostile.length);
  const places = new Set(all.map(({ x, y }) => `${x} ${y}`));
  assert.equal(places.size, all.length);
  assert.ok(all.every(({ x, y }) => Number.isFinite(x) && Number.isFinite(y)));
});

test("200 nodes and 2000 topics are laid out at once", () => {
  const topics = Array.from({ length: 2000 }, (_, i) =>
    topic(
      `/robot${i % 20}/part${i % 7}/topic${i}`,
      [`/robot${i % 20}/node${((i / 20) % 10) | 0}`],
      [`/robot${i % 20}/node${(i * 7) % 10}`, `/robot${(i + 1) % 20}/node${((i / 20) % 10) | 0}`],
    ),
  );
  const start = process.cpuUsage();
  const { boxes } = layOut(topics, () => false);
  const { user } = process.cpuUsage(start);
  assert.equal(boxes.size, 2200);
  assert.ok(user < 2e6, `${user / 1000} ms of a processor`); // about 0.1 s
  assert.ok(layOut(topics, () => true).boxes.size <= 20);
});

test("a whole drawing is in the middle, never enlarged", () => {
  const canvas = { width: 200, height: 100 };
  assert.deepEqual(whole({ width: 400, height: 100 }, canvas), { x: 0, y: -50, scale: 0.5 });
  assert.deepEqual(whole({ width: 100, height: 50 }, canvas), { x: -50, y: -25, scale: 1 });
  assert.equal(whole({ width: 1e9, height: 1 }, canvas).scale, 0.02);
});

test("zooming keeps the point under the pointer, and a search centres its box", () => {
  const look = { x: 10, y: 20, scale: 0.5 };
  assert.deepEqual(zoomed(look, 4, 30, 40), { x: 55, y: 80, scale: 2 });
  assert.equal(zoomed(look, 1e9, 0, 0).scale, 3);
  const box = boxOf({ x: 100, y: 82, width: 100 });
  const size = { width: 80, height: 40 };
  assert.deepEqual(centred(look, box, size), { x: 100, y: 75, scale: 0.8 });
  assert.equal(centred({ ...look, scale: 2 }, box, size).scale, 2);
});

test("a box is hit within its edges", () => {
  const boxes = new Map([["a", boxOf({ x: 10, y: 10, width: 100 })]]);
  const look = { x: 0, y: 0, scale: 0.5 };
  for (const [x, y] of [
    [5, 5],
    [55, 23],
  ])
    assert.equal(boxAt(boxes, look, x, y), boxes.get("a"));
  assert.equal(boxAt(boxes, look, 55, 24), undefined);
  assert.equal(boxAt(boxes, look, 4, 5), undefined);
});

test("a search counts boxes and rows folded in them", () => {
  const drawing = layOut(CHAIN, () => false);
  assert.equal(finder("  "), null);
  assert.equal(sumText(drawing, finder("M AM")), "1 of 6");
  assert.equal(sumText(drawing, null), "6 boxes");
  drawing.links[0].why = "It does not arrive.";
  assert.equal(sumText(drawing, null), "6 boxes, 1 QoS mismatch");
  drawing.links[1].why = "Nor does it.";
  assert.equal(sumText(drawing, null), "6 boxes, 2 QoS mismatches");
  assert.ok(finder("inner")?.(boxOf({ name: "/a", topics: ["/a/inner"] })));
});

test("the highest rate of several topics counts, with few digits", () => {
  assert.equal(rateText([]), "");
  assert.equal(rateText([0.2, 9.98]), "10 Hz");
  assert.equal(rateText([2.512]), "2.5 Hz");
  assert.equal(rateText([99.6]), "100 Hz");
});

test("a group is unfolded, and the innermost namespace that is open is folded", () => {
  const [all, none] = [new Set(["/a", "/a/b"]), new Set()];
  assert.deepEqual(foldsOf(boxOf({ name: "/a", kind: "group" }), all, none), [["Unfold", "/a"]]);
  assert.deepEqual(foldsOf(boxOf({ name: "/a/b/x", kind: "topic" }), all, all), [
    ["Fold /a/b", "/a/b"],
  ]);
  assert.deepEqual(foldsOf(boxOf({ name: "/x", kind: "topic" }), all, all), []);
});
