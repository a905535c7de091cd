import assert from "node:assert/strict";
import { test } from "node:test";

import { begin } from "../../webviz/page/web/handles/drags.js";
import { heldText, helpOf } from "../../webviz/page/web/handles/help.js";

const S = Math.SQRT1_2;
const IDENTITY = [1, 0, 0, 0];
const DOWN = [S, 0, S, 0]; // turns the x axis to -z
const QUARTER = Math.PI / 2;

// The camera is 10 m above and sees 100 pixels a metre, without perspective.
const place = ([x, y]) => [100 * x, -100 * y];
const projection = {
  rayAt: ([x, y]) => ({ origin: [x / 100, -y / 100, 10], direction: [0, 0, -1] }),
  project: place,
  perPixel: () => 0.01,
  unit: () => 1,
  right: [1, 0, 0],
  up: [0, 1, 0],
  forward: [0, 0, -1],
};

/** The pose, and the angle, of a handle at a position that is gripped at a point and dragged. */
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

function assertPose(moved, position, wxyz = IDENTITY, turned = 0) {
  const [found, wanted] = [
    [...moved.position, ...moved.wxyz, moved.turned],
    [...position, ...wxyz, turned],
  ];
  found.forEach((value, i) =>
    assert.ok(Math.abs(value - wanted[i]) < 1e-9, `${found}, not ${wanted}`),
  );
}

const ORIGIN = [0, 0, 0];

test("along an axis, it goes as far as the pointer does, however far beside the axis that is", () => {
  assertPose(dragged({ mode: "move_axis" }, [1, 2, 0], [1.7, 2, 0], { to: [2.7, 5] }), [2, 2, 0]);
});

test("in a plane, it follows the pointer", () => {
  const control = { mode: "move_plane", wxyz: DOWN };
  assertPose(dragged(control, [1, 2, 0], [1, 2, 0.3], { to: [2, 3] }), [2, 3, 0]);
});

test("facing the camera, the plane is that of the screen, whatever the control says", () => {
  const control = { mode: "move_plane", facing: "view_facing" };
  assertPose(dragged(control, [0, 0, 5], [0, 0, 5], { to: [2, 3] }), [2, 3, 5]);
});

test("a quarter to the left is a quarter to the right about -z", () => {
  const control = { mode: "rotate_axis", wxyz: DOWN };
  assertPose(
    dragged(control, [1, 2, 0], [2, 2, 0], { to: [1, 4] }),
    [1, 2, 0],
    [S, 0, 0, S],
    -QUARTER,
  );
});

test("towed by a rope, it follows the pointer and turns to it", () => {
  const control = { mode: "move_rotate", wxyz: DOWN };
  assertPose(dragged(control, ORIGIN, [1, 0, 0], { to: [2, 0] }), [1, 0, 0]);
  assertPose(dragged(control, ORIGIN, [1, 0, 0], { to: [0, 1] }), ORIGIN, [S, 0, 0, S], -QUARTER);
});

test("freely, it moves in the plane of the screen, and in depth by Shift or the wheel", () => {
  const control = { mode: "move_3d" };
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
  for (const control of [
    { mode: "move_axis", wxyz: DOWN },
    { mode: "move_plane" },
    { mode: "button" },
  ]) {
    assert.equal(dragged(control, ORIGIN, ORIGIN, { to: [2, 3] }), null, control.mode);
  }
});

test("the hint of a handle names its buttons, and who drags it", () => {
  const handle = { name: "Dock", holder: null, menu: [] };
  const help = (more, control, refusal = "") => helpOf({ ...handle, ...more }, control, refusal);
  assert.equal(help({}, { mode: "move_axis", help: "" }), "Dock Left-click: Move.");
  assert.equal(
    help({ menu: [{}], holder: 2 }, { mode: "rotate_axis", help: "Turn it." }),
    "Turn it. Left-click: Rotate. Right-click: Show context menu. In use by browser 2.",
  );
  assert.equal(help({ menu: [{}] }, { mode: "menu", help: "" }), "Dock Left-click: Show menu.");
  assert.equal(help({}, { mode: "button", help: "" }, "Only watching."), "Dock: Only watching.");
  assert.equal(heldText(handle), "");
});
