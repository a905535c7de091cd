import assert from "node:assert/strict";
import { test } from "node:test";

import { foldable, layOut } from "../../webviz/panels/graph.js";

const topic = (name, from, to) => ({ name, type: "T", from, to: to.map((node) => [node, ""]) });
const CHAIN = [
  topic("/scan", ["/driver"], ["/amcl"]),
  topic("/pose", ["/amcl"], ["/planner"]),
  topic("/cmd", ["/planner"], ["/driver"]),
];
const layerOf = ({ boxes }, key) => boxes.get(key).layer;

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

test("boxes do not cover each other, whatever they are called", () => {
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
