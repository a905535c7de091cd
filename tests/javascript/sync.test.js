import assert from "node:assert/strict";
import { mock, test } from "node:test";

import { sync } from "../../webviz/page/web/controls/sync.js";
import { signal } from "../../webviz/page/web/signals.js";

/** @import {Mixed} from "webviz/controls/mixed.js" */
/** @import {Outcome} from "webviz/types.js" */

mock.timers.enable({ apis: ["setTimeout"] });

/** A control, what it shows and why it was refused, and how the viewer answers. */
function control() {
  const seen = {
    shown: /** @type {(number | Mixed)[]} */ ([]),
    refusals: /** @type {string[]} */ ([]),
    answer: (/** @type {Outcome} */ _answer) => {},
  };
  const had = signal(/** @type {number | undefined} */ (undefined));
  const it = sync({
    value: () => had.value,
    show: (/** @type {number | Mixed} */ value) => seen.shown.push(value),
    change: () => new Promise((resolve) => Object.assign(seen, { answer: resolve })),
    refused: (text) => seen.refusals.push(text),
    isFocused: () => true,
  });
  return { it, seen, has: (/** @type {number} */ value) => (had.value = value) };
}

/** Lets promises that are settled call what waits for them. */
const turn = () => new Promise((resolve) => setImmediate(resolve));

test("a refused value stays for correction", async () => {
  const { it, seen, has } = control();
  has(1);
  it.hold();
  it.edit(-1);
  it.release();
  seen.answer({ level: "error", text: "Not changed: expected > 0." });
  await turn();
  has(1);
  mock.timers.tick(60_000);
  assert.deepEqual(seen.shown, [1]);
  assert.deepEqual(seen.refusals, ["Not changed: expected > 0."]);
  it.cancel();
  assert.deepEqual([seen.shown, seen.refusals.at(-1)], [[1, 1], ""]);
});

test("older values do not set a control back, and the newest is shown in the end", async () => {
  const { it, seen, has } = control();
  has(1);
  it.edit(2);
  has(1);
  seen.answer({ level: "ok", text: "" });
  await turn();
  has(1);
  has(2);
  assert.deepEqual(seen.shown, [1], "it moves under the hand");
  mock.timers.tick(500);
  assert.deepEqual(seen.shown, [1, 2]);
});

test("a viewer that does not answer is reported", async () => {
  const { it, seen } = control();
  it.edit(2);
  mock.timers.tick(8000);
  await turn();
  assert.match(seen.refusals.at(-1) ?? "", /does not answer/);
});
