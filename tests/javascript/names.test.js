import assert from "node:assert/strict";
import { test } from "node:test";

import { inWords, rounded } from "../../webviz/page/web/overlay/lengths.js";
import { checkedName } from "../../webviz/features/files/file_names.js";
import { search } from "../../webviz/page/web/controls/option_list.js";

test("a file name without a known suffix becomes YAML", () => {
  const names = {
    "lab.yaml": "lab.yaml",
    " lab ": "lab.yaml",
    "lab.yml": "lab.yml",
    "nav2.RVIZ": "nav2.RVIZ",
    "v1.2": "v1.2.yaml",
    ".bashrc": ".bashrc.yaml",
    ".yaml": ".yaml.yaml",
    "世界 🤖": "世界 🤖.yaml",
  };
  for (const [entered, name] of Object.entries(names))
    assert.deepEqual(checkedName(entered), { name });
});

test("a file name that leaves the folder is refused", () => {
  for (const entered of ["", "  ", ".", "..", "a/b.yaml", "../x", "a\\b", "a\0b", "/etc/x"]) {
    assert.match(checkedName(entered).problem ?? "", /name/, entered);
  }
});

test("lengths are round and in the unit that suits them", () => {
  const lengths = [0.00031, 0.0049, 0.03, 0.99, 1, 7, 25, 1999, 2000, 6e6];
  assert.deepEqual(
    lengths.map((each) => inWords(rounded(each))),
    ["0.2 mm", "2 mm", "2 cm", "50 cm", "1 m", "5 m", "20 m", "1 km", "2 km", "5000 km"],
  );
});

test("a search finds names with all words, the best match first", () => {
  const all = [
    ["Depth image", "a cloud of points"],
    ["Incloudy", ""],
    ["My cloud", ""],
    ["Hair/cloud", ""],
    ["Cloud", ""],
    ["Grid", ""],
  ];
  const matches = (/** @type {string} */ text) =>
    search(all, text, (each) => each).map(([title]) => title);
  assert.deepEqual(matches("cloud"), [
    "Cloud",
    "My cloud",
    "Hair/cloud",
    "Incloudy",
    "Depth image",
  ]);
  assert.deepEqual(matches("POINTS depth"), ["Depth image"]);
  assert.deepEqual(matches("cloud grid"), []);
  assert.equal(
    search(all, "  ", (each) => each),
    all,
  );
});
