import assert from "node:assert/strict";
import { test } from "node:test";

import { ageText, factOf } from "../../webviz/page/web/panels/frame_rows.js";
import { arranged } from "../../webviz/page/web/panels/topics_table.js";

/** @import {Frame} from "webviz/contents.js" */
/** @import {TopicRow} from "webviz/panels/topics_table.js" */

/**
 * @param {string} key
 * @param {Partial<TopicRow>} [more]
 * @returns {TopicRow}
 */
const topic = (key, more) => ({
  key,
  types: [],
  nodes: [],
  subscribers: null,
  qos: "",
  show: [],
  why: "",
  ...more,
});
const TOPICS = [
  topic("/b", { types: ["sensor_msgs/msg/Image"] }),
  topic("/slow", { hz: 0.5 }),
  topic("/fast", { hz: 100 }),
  topic("/a"),
];
/**
 * @param {string} text
 * @param {string} column
 * @param {boolean} isUp
 */
const names = (text, column, isUp) =>
  arranged(TOPICS, text, { column, isUp }).map(({ key }) => key);

test("topics without a rate are the slowest, and equal ones are in the order of their names", () => {
  assert.deepEqual(names("", "rate", false), ["/fast", "/slow", "/a", "/b"]);
  assert.deepEqual(names("", "rate", true), ["/a", "/b", "/slow", "/fast"]);
});

test("a column that is gone since it was remembered sorts by names", () => {
  assert.deepEqual(names("", "gone", true), ["/a", "/b", "/fast", "/slow"]);
});

test("topics are found by words of their names and types in any order", () => {
  assert.deepEqual(names("image /B", "name", true), ["/b"]);
});

/**
 * @param {Partial<Frame>} more
 * @returns {Frame}
 */
const frame = (more) => ({
  parent: "map",
  is_static: false,
  nodes: [],
  hz: 10,
  age: 0.2,
  samples: 2,
  problems: [],
  ...more,
});

test("a frame is static, has a rate, or too few transforms for one", () => {
  const facts = [{ is_static: true }, {}, { hz: 0 }, { hz: 0, samples: 0 }].map((more) =>
    factOf(frame(more)),
  );
  assert.deepEqual(facts, ["static", "10.0 Hz", "one sample", "no data"]);
  assert.equal(factOf(null), "");
});

test("a transform from the future is ahead, and one just now is no age below zero", () => {
  const ages = [-2, -0.1, 0.2, null].map((age) => ageText(frame({ age })));
  assert.deepEqual(ages, ["2.0 s ahead", "0 ms", "200 ms", ""]);
});
