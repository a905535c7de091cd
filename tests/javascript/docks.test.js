import assert from "node:assert/strict";
import { test } from "node:test";

import {
  EMPTY,
  floated,
  layoutOf,
  moved,
  namesIn,
  namesOf,
  placeOf,
  shared,
  sized,
  sizesIn,
  targetAt,
  without,
} from "../../webviz/page/web/docks/places.js";

/** @import {Boxes, Layout, Target} from "webviz/docks/places.js" */

const NONE = { left: 0, top: 0, width: 0, height: 0 };

/**
 * @param {Target["place"]} place
 * @returns {Target}
 */
const at = (place, at = 0, left = 0, top = 0) => ({ place, at, left, top, box: NONE });
/**
 * @param {Layout} layout
 * @param {string} panel
 * @param {Parameters<typeof at>} where
 */
const place = (layout, panel, ...where) => moved(layout, panel, at(...where));

test("a panel stands in one place", () => {
  let layout = place(EMPTY, "Log", "beside");
  layout = place(layout, "Plot", "beside", 0);
  assert.deepEqual(namesOf(layout), ["Plot", "Log"]);
  layout = place(layout, "Log", "below");
  assert.deepEqual([layout.beside.length, layout.below.length], [1, 1]);
  assert.deepEqual(namesOf(place(layout, "Log", "tabs")), ["Plot"]);
  assert.deepEqual(without(without(layout, "Log"), "Plot"), EMPTY);
});

test("a panel becomes a tab of another's place, and leaves it", () => {
  /**
   * @param {Layout} layout
   * @param {string} panel
   * @param {string} into
   */
  const join = (layout, panel, into) => moved(layout, panel, { ...at("below"), into });
  let layout = place(place(EMPTY, "Log", "below"), "Plot", "beside");
  layout = join(layout, "Plot", "Log");
  assert.deepEqual([layout.beside, namesOf(layout)], [[], ["Log", "Plot"]]);
  layout = join(layout, "Table", "Plot");
  assert.deepEqual(layout.below, [{ panel: "Log", weight: 1, tabs: ["Plot", "Table"] }]);
  layout = place(layout, "Log", "below", 0);
  assert.deepEqual(layout.below.map(namesIn), [["Log"], ["Plot", "Table"]]);
  layout = shared(layout, "below", "Log", "Plot", 0.25);
  assert.deepEqual(
    layout.below.map(({ weight }) => weight),
    [0.5, 1.5],
  );
});

test("the head of a panel takes another as a tab", () => {
  const below = { left: 300, top: 600, width: 1000, height: 200 };
  const belowBoxes = [{ ...below, panel: "Log" }];
  const scene = { ...boxes.scene, height: 600 };
  const target = (/** @type {number} */ y) =>
    targetAt(700, y, { ...boxes, scene, below, belowBoxes });
  assert.deepEqual([target(610)?.place, target(610)?.into], ["below", "Log"]);
  assert.deepEqual(target(610)?.box, below);
  assert.equal(target(700)?.into, undefined);
});

test("a floating panel keeps its size, and stays over the scene", () => {
  let layout = place(EMPTY, "Log", "over", 0, 5, -3);
  const [{ left, top, width }] = layout.over;
  assert.deepEqual([left, top], [1 - width, 0]);
  layout = floated(layout, "Log", { width: 9, height: 0 });
  assert.deepEqual([layout.over[0].width, layout.over[0].height], [1, 0.05]);
  layout = place(layout, "Log", "over", 0, 0.5, 0.2);
  assert.deepEqual(layout.over[0], { panel: "Log", width: 1, height: 0.05, left: 0, top: 0.2 });
});

test("neighbours share their space", () => {
  let layout = place(place(EMPTY, "a", "below"), "b", "below", 1);
  layout = shared(layout, "below", "a", "b", 0.25);
  assert.deepEqual(
    layout.below.map(({ weight }) => weight),
    [0.5, 1.5],
  );
  layout = shared(layout, "below", "a", "b", -4);
  assert.equal(layout.below[0].weight, 0.05);
});

/** @type {Boxes} */
const boxes = {
  side: { left: 0, top: 0, width: 300, height: 800 },
  scene: { left: 300, top: 0, width: 1000, height: 800 },
  beside: NONE,
  below: NONE,
  besideBoxes: [],
  belowBoxes: [],
};

test("the edges of the scene are the places beside and below it", () => {
  /**
   * @param {number} x
   * @param {number} y
   */
  const target = (x, y) => targetAt(x, y, boxes);
  assert.equal(target(100, 400)?.place, "tabs");
  assert.equal(target(1290, 400)?.place, "beside");
  assert.equal(target(600, 790)?.place, "below");
  assert.equal(target(1295, 790)?.place, "beside");
  const over = target(800, 400);
  assert.deepEqual([over?.place, over?.left, over?.top], ["over", 0.5, 0.5]);
  assert.equal(target(2000, 400), null);
});

test("a row is entered between its panels", () => {
  const beside = { left: 1000, top: 0, width: 300, height: 800 };
  const half = { left: 1000, width: 300, height: 400 };
  const besideBoxes = [
    { ...half, top: 0, panel: "Log" },
    { ...half, top: 400, panel: "Plot" },
  ];
  const scene = { ...boxes.scene, width: 700 };
  const numbers = [100, 300, 790].map(
    (y) => targetAt(1100, y, { ...boxes, scene, beside, besideBoxes })?.at,
  );
  assert.deepEqual(numbers, [0, 1, 2]);
});

test("a layout of the server is complete, and each panel has one place", () => {
  assert.deepEqual(layoutOf(new Map()), EMPTY);
  const layout = layoutOf(new Map([["below", [{ panel: "Log", weight: 1, tabs: ["Table"] }]]]));
  assert.equal(placeOf(layout, "Log"), "below");
  assert.equal(placeOf(layout, "Table"), "below");
  assert.equal(placeOf(layout, "Plot"), "tabs");
});

test("panels leave room to the scene and keep a readable width", () => {
  const layout = { ...EMPTY, width: 700, height: 600 };
  assert.deepEqual(sizesIn(layout, { width: 1000, height: 500 }), { width: 600, height: 350 });
  assert.equal(sizesIn(layout, { width: 100, height: 500 }).width, 120);
  assert.equal(sized(layout, "width", 300.4).width, 300);
  assert.equal(sized(layout, "width", -5).width, 120);
  assert.equal(sized(layout, "height", 1e9).height, 4000);
});
