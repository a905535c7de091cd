import assert from "node:assert/strict";
import { test } from "node:test";

import { MIXED } from "../../webviz/page/web/controls/mixed.js";
import { commonOf, filled, valuesOf } from "../../webviz/page/web/panels/displays/common.js";
import {
  arrange,
  editable,
  globalItem,
  placeAmong,
  topmost,
  visible,
} from "../../webviz/page/web/panels/displays/model.js";
import { below, moves, step } from "../../webviz/page/web/panels/displays/places.js";
import { storeOf } from "./values.js";

/** @import {DeclaredProperty, DisplayRow} from "webviz/contents.js" */
/** @import {Item, Place, Way} from "webviz/panels/displays/types.js" */

/**
 * @param {string} name
 * @param {number} depth
 * @param {Partial<DisplayRow>} [more]
 */
const row = (name, depth, more = {}) => ({
  name,
  depth,
  type: "Grid",
  topics: [],
  enabled: true,
  ...more,
});
/**
 * @param {string} name
 * @param {number} depth
 * @param {Partial<DisplayRow>} [more]
 */
const group = (name, depth, more = {}) => row(name, depth, { type: "Group", ...more });

/** A group with a display and a group in it, and a display before and behind it. */
const MODEL = arrange(
  storeOf("displays", {
    order: ["a", "g", "b", "h", "c", "d"],
    a: row("Same", 0),
    g: group("Robot", 0, { enabled: false }),
    b: row("Scan", 1, { topics: ["/front/scan"] }),
    h: group("Inner", 1),
    c: row("Same", 2),
    d: row("Same", 0),
  }),
);
/** @param {string} id */
function itemOf(id, model = MODEL) {
  const item = model.byId.get(id);
  assert.ok(item);
  return item;
}
/** @param {Pick<Item, "id">[]} items */
const ids = (items) => items.map(({ id }) => id).join("");
const always = () => true;

test("rows with depths become a tree, and a group that is off switches off its displays", () => {
  assert.equal(ids(MODEL.top), "agd");
  assert.equal(ids(itemOf("g").children), "bh");
  assert.equal(itemOf("c").parent, itemOf("h"));
  assert.equal(ids(MODEL.items.filter(({ isActive }) => isActive)), "ad");
  const deep = arrange(
    storeOf("displays", { order: ["x", "y"], x: group("x", 0), y: row("y", 9) }),
  );
  assert.equal(itemOf("y", deep).parent, itemOf("x", deep));
  assert.deepEqual(arrange(storeOf("displays", {})).items, []);
});

test("rows count their siblings, those on top with the global options", () => {
  /** @param {string} id */
  const place = (id) => Object.values(placeAmong(MODEL, itemOf(id)));
  assert.deepEqual(
    [place("a"), place("d"), place("b")],
    [
      [2, 4],
      [4, 4],
      [1, 2],
    ],
  );
  assert.deepEqual(placeAmong(MODEL, globalItem(null)), { position: 1, count: 4 });
});

test("a single selected item is always shown, several only if they can be edited", () => {
  const items = [
    globalItem(null),
    { ...itemOf("a"), can_edit: true },
    { ...itemOf("b"), can_edit: true },
    { ...itemOf("g"), can_edit: true },
    { ...itemOf("c"), id: "x", can_edit: false },
  ];
  /** @param {...string} wanted */
  const chosen = (...wanted) => ids(editable(items, (id) => wanted.includes(id)));
  for (const id of ["global", "a", "g", "x"]) assert.equal(chosen(id), id);
  assert.equal(chosen("global", "a", "b", "g", "x"), "ab");
  assert.equal(chosen(), "");
});

test("paths are of names, short and each its own", () => {
  const paths = MODEL.items.map(({ path }) => path);
  assert.deepEqual(paths, [
    "/Same",
    "/Robot",
    "/Robot/Scan",
    "/Robot/Inner",
    "/Robot/Inner/Same",
    "/Same#2",
  ]);
  const [item] = arrange(storeOf("displays", { order: ["x"], x: row("y".repeat(1e5), 0) })).items;
  assert.ok(item.path.length < 100);
});

test("rows of folded groups are not shown", () => {
  assert.equal(ids(visible(MODEL, always, " ")), "agbhcd");
  assert.equal(ids(visible(MODEL, ({ id }) => id === "g", "")), "agbhd");
});

test("a search shows matching displays with their groups, and all displays of matching groups", () => {
  /** @param {string} text */
  const search = (text) => ids(visible(MODEL, () => false, text));
  assert.equal(search("FRONT grid"), "gb");
  assert.equal(search("same"), "aghcd");
  assert.equal(search("robot"), "gbhc");
  assert.equal(search("inner"), "ghc");
  assert.equal(search("nothing"), "");
});

test("a display selected together with its group moves with the group", () => {
  assert.equal(ids(topmost(MODEL, new Set(["c", "g", "d"]))), "gd");
});

test("the row on top has the worst status of the viewer", () => {
  const statuses = [
    ["Time", "warn", "slow", ""],
    ["Frame", "error", "no frame", "choose another"],
  ];
  const item = globalItem(storeOf("settings", { statuses, frame_rate: 29.97, fixed_frame: "map" }));
  assert.deepEqual([item.level, item.line, item.remedy], ["error", "no frame", "choose another"]);
  assert.equal(item.note, "map, 30 Hz");
  const { level, note } = globalItem(storeOf("settings", {}));
  assert.deepEqual([level, note], ["ok", ""]);
});

test("a place below a row has a depth that is possible there", () => {
  const rows = MODEL.items;
  /**
   * @param {number} index
   * @param {number} depth
   * @param {string[]} [moved]
   */
  const at = (index, depth, moved = [], isOpen = always) =>
    below(MODEL, rows, index, depth, new Set(moved), isOpen);
  assert.deepEqual(at(-1, 0), { group: "", before: "a", depth: 0 });
  assert.deepEqual(at(0, 9), { group: "", before: "g", depth: 0 });
  assert.deepEqual(at(1, 0), { group: "g", before: "b", depth: 1 }, "an open group is entered");
  assert.deepEqual(
    at(1, 1, ["b", "h"], () => false),
    { group: "", before: "d", depth: 0 },
    "a folded one is not",
  );
  assert.deepEqual(at(4, 2), { group: "h", before: "", depth: 2 });
  assert.deepEqual(at(4, 1), { group: "g", before: "", depth: 1 });
  assert.deepEqual(at(4, -5), { group: "", before: "d", depth: 0 });
  assert.deepEqual(
    at(1, 1, ["b"]),
    { group: "g", before: "h", depth: 1 },
    "what moves is not there",
  );
  assert.deepEqual(at(-1, 0, ["a", "g", "d"]), { group: "", before: "", depth: 0 });
});

test("keys move up, down, out of a group and into one", () => {
  /**
   * @param {string} id
   * @param {Way} way
   */
  const to = (id, way) => step(MODEL, new Set(id), way);
  assert.deepEqual(to("d", "up"), { group: "", before: "g" });
  assert.deepEqual(to("a", "down"), { group: "", before: "d" });
  assert.deepEqual(to("c", "out"), { group: "g", before: "" });
  assert.deepEqual(to("d", "into"), { group: "g", before: "", depth: 1 });
  /** @type {[string, Way][]} */
  const nowhere = [
    ["a", "up"],
    ["d", "down"],
    ["a", "out"],
    ["a", "into"],
    ["", "up"],
  ];
  for (const [id, way] of nowhere) {
    assert.equal(to(id, way), null, way);
  }
  assert.deepEqual(to("bd", "out"), { group: "", before: "" }, "what moves is not there");
  assert.deepEqual(to("ag", "down"), { group: "", before: "" }, "several stay together");
});

test("a drop at the present place moves nothing", () => {
  /**
   * @param {string} id
   * @param {Place} place
   */
  const to = (id, place) =>
    moves(MODEL, new Set(id), place)
      .map(({ display }) => display)
      .join("");
  assert.equal(to("a", { group: "", before: "g" }), "");
  assert.equal(to("ag", { group: "", before: "d" }), "");
  assert.equal(to("a", { group: "", before: "d" }), "a");
  assert.equal(to("ab", { group: "", before: "d" }), "ab");
  assert.equal(to("ad", { group: "", before: "" }), "ad");
  assert.equal(to("bh", { group: "g", before: "" }), "");
  assert.equal(to("", { group: "", before: "" }), "");
});

/**
 * A property with what a test says of it.
 *
 * @param {Partial<DeclaredProperty>} said
 * @returns {DeclaredProperty}
 */
const property = (said) => ({ path: "", label: "", kind: "text", offered: false, ...said });
const number = property({
  path: "size",
  kind: "float",
  label: "Size",
  unit: "m",
  low: 0,
  default: 1,
});

test("nothing moves into a group that somebody has removed", () => {
  assert.deepEqual(moves(MODEL, new Set("a"), { group: "gone", before: "" }), []);
});

test("properties are common if they are declared alike; other defaults and help do not matter", () => {
  assert.deepEqual(commonOf([[number], [{ ...number, help: "of points" }]]), [number]);
  const { default: _standard, ...rest } = number;
  assert.deepEqual(commonOf([[number], [{ ...number, default: 2 }]]), [rest]);
  /** @type {Partial<DeclaredProperty>[]} */
  const others = [{ unit: "px" }, { low: 1 }, { path: "width" }, { kind: "int" }];
  for (const other of others) {
    assert.deepEqual(commonOf([[number], [{ ...number, ...other }]]), []);
  }
  const switches = property({ path: "shown", kind: "switches", label: "Shown" });
  assert.deepEqual(commonOf([[switches], [switches]]), []);
});

test("topics of other types have their QoS in common, and no name", () => {
  const topic = property({
    path: "topic",
    kind: "topic",
    label: "Topic",
    type: "A",
    children: [property({ path: "topic.name" }), number],
  });
  assert.deepEqual(commonOf([[topic], [topic]])[0].children?.length, 2);
  const [{ kind, label, children }] = commonOf([[topic], [{ ...topic, type: "B" }]]);
  assert.deepEqual([kind, label, children], ["group", "QoS", [number]]);
});

test("values that are not equal are mixed, of vectors each element", () => {
  const place = property({ path: "at", kind: "vector" });
  /** @type {[number, number[]][]} */
  const both = [
    [1, [0, 1]],
    [2, [0, 2]],
  ];
  const stores = both.map(
    ([size, at]) => new Map(Object.entries({ "value.size": size, "value.at": at })),
  );
  const values = valuesOf(stores, [property({ children: [number] }), place]);
  assert.deepEqual(
    [...values],
    [
      ["value.size", MIXED],
      ["value.at", [0, MIXED]],
    ],
  );
  assert.deepEqual(filled([7, MIXED], [1, 2]), [7, 2]);
  assert.equal(filled(5, 3), 5);
});
