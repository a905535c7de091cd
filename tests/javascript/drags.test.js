import assert from "node:assert/strict";
import { test } from "node:test";

import { begin } from "../../webviz/features/handles/drags.js";
import { heldText, helpOf } from "../../webviz/features/handles/help.js";

/** @import {HandleControl, SceneHandle} from "webviz/contents.js" */
/** @import {Control, Moved, View} from "webviz/features/handles/drags.js" */
/** @import {Vec2, Vec3, Wxyz} from "webviz/types.js" */

/** @typedef {Partial<Control> & Pick<Control, "mode">} GivenControl */

const S = Math.SQRT1_2;
/** @type {Wxyz} */
const IDENTITY = [1, 0, 0, 0];
/** @type {Wxyz} */
const DOWN = [S, 0, S, 0]; // turns the x axis to -z
const QUARTER = Math.PI / 2;

// The camera is 10 m above and sees 100 pixels a metre, without perspective.
/**
 * @param {number[]} point
 * @returns {Vec2}
 */
const place = ([x, y]) => [100 * x, -100 * y];
/** @type {View} */
const projection = {
  rayAt: ([x, y]) => ({ origin: [x / 100, -y / 100, 10], direction: [0, 0, -1] }),
  project: place,
  perPixel: () => 0.01,
  unit: () => 1,
  right: [1, 0, 0],
  up: [0, 1, 0],
  forward: [0, 0, -1],
};

/**
 * The pose, and the angle, of a handle at a position that is gripped at a point and dragged.
 *
 * @param {GivenControl} control
 * @param {Vec3} position
 * @param {Vec3} grab
 * @param {...{to: Vec2, wheel?: number, shift?: boolean, ctrl?: boolean}} pointers
 */
function dragged({ mode, wxyz = IDENTITY, facing = "inherit" }, position, grab, ...pointers) {
  let before = place(grab);
  const pose = { position, wxyz: IDENTITY };
  const step = begin({
    control: { mode, wxyz, facing },
    pose,
    turned: 0,
    grab,
    projection,
    at: before,
  });
  /** @type {Partial<Moved> | null} */
  let moved = null;
  for (const { to, wheel = 0, shift = false, ctrl = false } of pointers) {
    const at = place(to);
    moved = step(
      { at, by: [at[0] - before[0], at[1] - before[1]], wheel, shift, ctrl },
      projection,
    );
    before = at;
  }
  return moved;
}

/**
 * @param {Partial<Moved> | null} moved
 * @param {Vec3} position
 */
function assertPose(moved, position, wxyz = IDENTITY, turned = 0) {
  assert.ok(moved?.position && moved.wxyz);
  const [found, wanted] = [
    [...moved.position, ...moved.wxyz, moved.turned ?? NaN],
    [...position, ...wxyz, turned],
  ];
  found.forEach((value, i) =>
    assert.ok(Math.abs(value - wanted[i]) < 1e-9, `${found}, not ${wanted}`),
  );
}

/** @type {Vec3} */
const ORIGIN = [0, 0, 0];

test("along an axis, it goes as far as the pointer does, however far beside the axis that is", () => {
  assertPose(dragged({ mode: "move_axis" }, [1, 2, 0], [1.7, 2, 0], { to: [2.7, 5] }), [2, 2, 0]);
});

test("in a plane, it follows the pointer", () => {
  /** @type {GivenControl} */
  const control = { mode: "move_plane", wxyz: DOWN };
  assertPose(dragged(control, [1, 2, 0], [1, 2, 0.3], { to: [2, 3] }), [2, 3, 0]);
});

test("the plane of a control that faces the camera is that of the screen", () => {
  /** @type {GivenControl} */
  const control = { mode: "move_plane", facing: "view_facing" };
  assertPose(dragged(control, [0, 0, 5], [0, 0, 5], { to: [2, 3] }), [2, 3, 5]);
});

test("a quarter to the left is a quarter to the right about -z", () => {
  /** @type {GivenControl} */
  const control = { mode: "rotate_axis", wxyz: DOWN };
  assertPose(
    dragged(control, [1, 2, 0], [2, 2, 0], { to: [1, 4] }),
    [1, 2, 0],
    [S, 0, 0, S],
    -QUARTER,
  );
});

test("towed by a rope, it follows the pointer and turns to it", () => {
  /** @type {GivenControl} */
  const control = { mode: "move_rotate", wxyz: DOWN };
  assertPose(dragged(control, ORIGIN, [1, 0, 0], { to: [2, 0] }), [1, 0, 0]);
  assertPose(dragged(control, ORIGIN, [1, 0, 0], { to: [0, 1] }), ORIGIN, [S, 0, 0, S], -QUARTER);
});

test("freely, it moves in the plane of the screen, and in depth by Shift or the wheel", () => {
  /** @type {GivenControl} */
  const control = { mode: "move_3d" };
  /** @type {Vec3} */
  const from = [1, 1, 1];
  assertPose(dragged(control, from, from, { to: [3, 0] }), [3, 0, 1]);
  // Up the screen is away from the camera, by 1 cm a pixel; a notch is 20 pixels closer.
  assertPose(dragged(control, from, from, { to: [1, 1.1], shift: true }), [1, 1, 0.9]);
  assertPose(dragged(control, from, from, { to: [1, 1], wheel: 1 }), [1, 1, 1.2]);
});

test("a move by Shift stays when Shift is let go", () => {
  const moved = dragged(
    { mode: "move_3d" },
    [1, 1, 1],
    [1, 1, 1],
    { to: [1, 2], shift: true },
    { to: [2, 2] },
  );
  assertPose(moved, [2, 1, 0]);
});

test("freely, 300 pixels are a whole turn: like a ball, or like a wheel with Shift", () => {
  /** @type {GivenControl} */
  const control = { mode: "rotate_3d" };
  assertPose(dragged(control, ORIGIN, ORIGIN, { to: [0.75, 0] }), ORIGIN, [S, 0, S, 0]);
  assertPose(dragged(control, ORIGIN, ORIGIN, { to: [0.75, 0], shift: true }), ORIGIN, [
    S,
    0,
    0,
    -S,
  ]);
});

test("of a control that moves and turns, Ctrl turns", () => {
  /** @type {GivenControl} */
  const control = { mode: "move_rotate_3d" };
  assertPose(dragged(control, ORIGIN, ORIGIN, { to: [1, 0] }), [1, 0, 0]);
  assertPose(dragged(control, ORIGIN, ORIGIN, { to: [0, -0.75], ctrl: true }), ORIGIN, [
    S,
    S,
    0,
    0,
  ]);
});

test("nothing moves along an axis that points to the camera, in a plane seen from its side, or by a button", () => {
  /** @type {GivenControl[]} */
  const controls = [{ mode: "move_axis", wxyz: DOWN }, { mode: "move_plane" }, { mode: "button" }];
  for (const control of controls) {
    assert.equal(dragged(control, ORIGIN, ORIGIN, { to: [2, 3] }), null, control.mode);
  }
});

/** @type {SceneHandle["menu"][number]} */
const ENTRY = { id: 1, title: "", checked: null, refusal: "", entries: [] };

test("the hint of a handle names its buttons and the browser that drags it", () => {
  /** @type {Pick<SceneHandle, "name" | "holder" | "menu">} */
  const handle = { name: "Dock", holder: null, menu: [] };
  /**
   * @param {Partial<Parameters<typeof helpOf>[0]>} more
   * @param {Pick<HandleControl, "mode" | "help">} control
   */
  const help = (more, control, refusal = "") => helpOf({ ...handle, ...more }, control, refusal);
  assert.equal(help({}, { mode: "move_axis", help: "" }), "Dock Left-click: Move.");
  assert.equal(
    help({ menu: [ENTRY], holder: 2 }, { mode: "rotate_axis", help: "Turn it." }),
    "Turn it. Left-click: Rotate. Right-click: Show context menu. In use by browser 2.",
  );
  assert.equal(help({ menu: [ENTRY] }, { mode: "menu", help: "" }), "Dock Left-click: Show menu.");
  assert.equal(help({}, { mode: "button", help: "" }, "Only watching."), "Dock: Only watching.");
  assert.equal(heldText(handle), "");
});
