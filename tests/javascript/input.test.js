import assert from "node:assert/strict";
import { afterEach, test } from "node:test";

import { bent, straight } from "../../webviz/page/web/images/undistort.js";
import { clicks } from "../../webviz/page/web/tools/clicks.js";
import { makeGamepad } from "../../webviz/features/driving/teleop_gamepad.js";

/** @import {SceneEvent, Vec2} from "webviz/types.js" */

/**
 * An event of a pointer, which Node.js does not have.
 *
 * @param {string} type
 * @param {number} x
 * @param {Partial<PointerEvent>} [more]
 */
const at = (type, x, more = {}) =>
  /** @type {PointerEvent} */ ({
    type,
    pointerId: 1,
    clientX: x,
    clientY: 0,
    button: 0,
    buttons: 0,
    ...more,
  });

/**
 * The names of what a pointer's events call.
 *
 * @param {...SceneEvent} events
 */
function heard(...events) {
  /** @type {string[]} */
  const calls = [];
  /** @param {string} name */
  const note = (name) => () => calls.push(name);
  const take = clicks(note("click"), note("right"), note("move"));
  for (const event of events) assert.equal(take(event), false, "the camera gets all events");
  return calls;
}

test("a button that is let go where it was pressed is a click", () => {
  assert.deepEqual(heard(at("pointerdown", 0), at("pointerup", 3)), ["click"]);
  assert.deepEqual(heard(at("pointerdown", 0), at("pointerup", 0, { button: 2 })), ["right"]);
  assert.deepEqual(heard(at("pointermove", 9)), ["move"]);
});

test("a drag, another pointer or one that is cancelled clicks nothing", () => {
  assert.deepEqual(heard(at("pointerdown", 0), at("pointerup", 4)), []);
  const back = [at("pointermove", 9, { buttons: 1 }), at("pointermove", 0, { buttons: 1 })];
  assert.deepEqual(heard(at("pointerdown", 0), ...back, at("pointerup", 0)), []);
  assert.deepEqual(heard(at("pointerdown", 0), at("pointerup", 0, { pointerId: 2 })), []);
  assert.deepEqual(heard(at("pointerdown", 0), at("pointercancel", 0), at("pointerup", 0)), []);
  assert.deepEqual(heard(at("pointerup", 0)), []);
});

/** @param {...({connected: boolean, axes: number[]} | null)} pads */
function plug(...pads) {
  Object.defineProperty(navigator, "getGamepads", { value: () => pads, configurable: true });
}

afterEach(() => Reflect.deleteProperty(navigator, "getGamepads"));

test("a gamepad drives once its sticks have been in their middle", () => {
  const { share } = makeGamepad();
  plug({ connected: true, axes: [0, -1, 0] });
  assert.deepEqual(share(), [0, 0, 0]);
  plug({ connected: true, axes: [0.1, -0.14, 0] });
  assert.deepEqual(share().map(Math.abs), [0, 0, 0]);
  plug(null, { connected: false, axes: [1, 1, 1] }, { connected: true, axes: [-0.575, -2, 0] });
  const [ahead, left, turn] = share();
  assert.deepEqual([ahead, Math.abs(left)], [1, 0], "at most the highest speed");
  assert.ok(Math.abs(turn - 0.5) < 1e-9);
});

test("without a gamepad, or with one of a single axis, nothing is held", () => {
  const { share } = makeGamepad();
  assert.deepEqual(share().map(Math.abs), [0, 0, 0]);
  plug({ connected: true, axes: [1] });
  assert.deepEqual(share().map(Math.abs), [0, 0, 0]);
});

/** The middle half of an image. */
const MIDDLE = {
  rows: 3,
  columns: 2,
  places: [0.25, 0.25, 0.75, 0.25, 0.25, 0.5, 0.75, 0.5, 0.25, 0.75, 0.75, 0.75],
};
/** The left half of an image, of which the lens does not see a corner. */
const HALF = { rows: 2, columns: 3, places: [0, 0, 0.25, 0, 0.5, 0, 0, 1, 0.25, 1, null, null] };

test("a place of an undistorted image is between the corners of its cell", () => {
  assert.deepEqual(straight(HALF, [0.25, 0.5]), [0.125, 0.5]);
  assert.deepEqual(straight(HALF, [0, 0]), [0, 0]);
  assert.deepEqual(straight(MIDDLE, [1, 0.5]), [0.75, 0.5]);
  assert.deepEqual(straight(MIDDLE, [0.5, 1]), [0.5, 0.75]);
});

test("places outside an undistorted image, or of a cell that the lens does not see, show nothing", () => {
  /** @type {Vec2[]} */
  const outside = [
    [-0.1, 0.6],
    [1.1, 0.6],
    [0.5, -0.1],
    [0.5, 1.1],
  ];
  for (const place of outside) {
    assert.equal(straight(MIDDLE, place), null, String(place));
  }
  /** @type {Vec2[]} */
  const unseen = [
    [0.75, 0.5],
    [0, 1],
  ];
  for (const place of unseen) assert.equal(straight(HALF, place), null, String(place));
});

test("a place of an image is where the undistorted image shows it", () => {
  const rows = 9;
  const columns = 13;
  const corners = [];
  for (let row = 0; row < rows; row++)
    for (let column = 0; column < columns; column++) {
      const [x, y] = [column / (columns - 1) - 0.5, row / (rows - 1) - 0.5];
      const swell = 1 - 0.5 * (x * x + y * y); // a barrel
      corners.push(0.5 + x * swell, 0.5 + y * swell);
    }
  const warp = { rows, columns, places: corners };
  /** @type {Vec2[]} */
  const places = [
    [0.5, 0.5],
    [0.1, 0.8],
    [0.93, 0.07],
  ];
  for (const place of places) {
    const share = straight(warp, place);
    const point = share && bent(warp, share);
    assert.ok(
      point && Math.hypot(point[0] - place[0], point[1] - place[1]) < 1e-4,
      `${place}: ${point}`,
    );
  }
  const beside = bent(warp, [0, 0]); // the corner of the image, which is not shown
  assert.ok(beside && beside[0] < 0 && beside[1] < 0, String(beside));
  assert.equal(bent({ rows: 2, columns: 2, places: Array(8).fill(null) }, [0.5, 0.5]), null);
});
