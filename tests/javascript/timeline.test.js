import assert from "node:assert/strict";
import { test } from "node:test";

import { offsetAfter } from "../../webviz/page/web/clock_offset.js";
import { newest } from "../../webviz/page/web/newest.js";
import {
  boundsOf,
  following,
  limited,
  nearest,
  placeOf,
  rebounded,
  shareAt,
  timeAt,
  zoomed,
} from "../../webviz/features/playback/range.js";
import { agoText, atMoment, beforeText, behindAt, isNow } from "../../webviz/page/web/moment.js";
import { savedText } from "../../webviz/page/web/time_text.js";
import { parseTime } from "../../webviz/features/playback/typed_time.js";
import { storeOf } from "./values.js";

/** @param {Record<string, unknown>} values */
const playback = (values) => storeOf("playback", values);

test("a window stays within the recording and keeps its length", () => {
  assert.deepEqual(limited([-5, 15], [0, 100]), [0, 20]);
  assert.deepEqual(limited([90, 110], [0, 100]), [80, 100]);
  assert.deepEqual(limited([-50, 150], [0, 100]), [0, 100]);
  assert.deepEqual(limited([-50, 10], [-40, 20]), [-40, 20]);
});

test("a window is not shorter than a hundredth of a second, unless the recording is", () => {
  const [from, to] = limited([50, 50], [0, 100]);
  assert.ok(Math.abs(to - from - 0.01) < 1e-9);
  assert.deepEqual(limited([0, 0], [0, 0.005]), [0, 0.005]);
  assert.deepEqual(limited([0, 1], [0, 0]), [0, 0]);
});

test("zooming keeps the time under the pointer", () => {
  assert.deepEqual(zoomed([0, 100], { around: 0.25, by: 0.5 }, [0, 100]), [12.5, 62.5]);
  assert.deepEqual(zoomed([12.5, 62.5], { around: 0.25, by: 2 }, [0, 100]), [0, 100]);
});

test("a window follows the head by whole windows", () => {
  assert.deepEqual(following([0, 10], 5, [0, 100]), [0, 10]);
  assert.deepEqual(following([0, 10], 27, [0, 100]), [20, 30]);
  assert.deepEqual(following([20, 30], 3, [0, 100]), [0, 10]);
  assert.deepEqual(following([0, 30], 99, [0, 100]), [70, 100]);
  assert.deepEqual(following([-60, -50], -33, [-60, 0]), [-40, -30]);
});

test("a timeline shows a whole bag, or the length of the memory of live topics", () => {
  /** @param {Record<string, unknown>} values */
  const bounds = (values) => boundsOf(new Map(Object.entries(values)));
  assert.deepEqual(bounds({ is_live: null, duration: 5 }), [0, 5]);
  assert.deepEqual(bounds({ is_live: null, duration: 0 }), [0, 0.01]);
  const live = { is_live: true, duration: 100, first: 95, limit: 60 };
  assert.deepEqual(bounds(live), [40, 100]);
  assert.deepEqual(bounds({ ...live, is_live: false }), [95, 100]);
});

test("a window stays as time goes on, unless it was whole or its start is forgotten", () => {
  assert.deepEqual(rebounded([2, 3], [0, 10], [0, 10], true), [2, 3]);
  assert.deepEqual(rebounded([2, 3], [0, 10], [0, 20], true), [0, 20], "another bag");
  assert.deepEqual(rebounded([2, 3], [0, 10], [1, 11], false), [2, 3]);
  assert.deepEqual(rebounded([0, 10], [0, 10], [1, 11], false), [1, 11]);
  assert.deepEqual(rebounded([2, 3], [0, 10], [2.5, 12.5], false), [2.5, 12.5]);
});

test("places and times of a timeline belong together", () => {
  assert.equal(placeOf(25, [0, 100], 216), 58);
  assert.equal(timeAt(58, [0, 100], 216), 25);
  assert.equal(shareAt(8, 0), 0, "of one without a width");
});

test("the nearest mark within a few pixels is found, the first of equal ones", () => {
  /** @type {[number, string][]} */
  const marks = [
    [10, "a"],
    [13, "b"],
    [13, "c"],
    [30, "d"],
  ];
  assert.deepEqual(
    nearest(marks, ([x]) => x, 14),
    [13, "b"],
  );
  assert.deepEqual(
    nearest(marks, ([x]) => x, 25),
    [30, "d"],
  );
  assert.equal(
    nearest(marks, ([x]) => x, 24.9),
    null,
  );
});

test("while a value is under way, only the newest of the others is kept", async () => {
  /** @type {number[]} */
  const sent = [];
  /** @type {((value?: unknown) => void)[]} */
  const arrived = [];
  const sending = newest((value) => {
    sent.push(value);
    return new Promise((resolve) => arrived.push(resolve));
  });
  const done = sending.to(1);
  for (const value of [2, 3]) sending.to(value);
  assert.deepEqual([sent, sending.target()], [[1], 3]);
  arrived[0]();
  await Promise.resolve();
  assert.deepEqual(sent, [1, 3]);
  arrived[1]();
  await done;
  assert.equal(sending.target(), null);
});

test("typed times are seconds, minutes and hours, or a date", () => {
  assert.equal(parseTime("12.4", 0), 12.4);
  assert.equal(parseTime(" 90 ", 0), 90);
  assert.equal(parseTime("1:12", 0), 72);
  assert.equal(parseTime("1:02:03.5", 0), 3723.5);
  assert.equal(parseTime("2023-11-14 22:13:50.5Z", 1_700_000_000), 30.5);
  for (const wrong of ["", "soon", "1:2:3:4", "-3", "2023-99-99 00:00", "1e5"]) {
    assert.equal(parseTime(wrong, 0), null, wrong);
  }
});

test("the past of live topics goes on with time", () => {
  const live = playback({ start: 1000, ahead: 2, is_live: true, memory_s: 60 });
  const now = atMoment(live, 1102);
  assert.deepEqual(
    [now.get("first"), now.get("duration"), now.get("position"), now.get("ago")],
    [40, 100, 100, 0],
  );
  const paused = atMoment(live, 1102, 12.5);
  assert.deepEqual([paused.get("position"), paused.get("duration")], [87.5, 100]);
  assert.equal(atMoment(live, 1102, 500).get("position"), 40, "no longer held");
  const past = playback({ start: 1000, ahead: 2, is_live: false, first: 40, position: 90 });
  assert.equal(atMoment(past, 1102).get("ago"), 10);
  assert.equal(atMoment(past, 1105.5).get("ago"), 13.5);
  assert.equal(isNow(atMoment(past, 1102), 99.8, 60), true);
  assert.equal(isNow(atMoment(past, 1102), 99, 60), false);
});

test("a bag is nowhere near now", () => {
  const bag = atMoment(playback({ start: 0, is_live: null, duration: 5, position: 5 }), 1e9);
  assert.deepEqual([bag.get("first"), bag.get("ago"), isNow(bag, 5, 5)], [0, 0, false]);
});

test("a paused scene is as far behind as it stands, a running one is not", () => {
  /**
   * @param {boolean} is_paused
   * @param {number} rate
   */
  const clock = (is_paused, rate) => storeOf("clock", { is_paused, pace: [5, 1090, rate] });
  assert.equal(behindAt(clock(true, 0), 1102), 12);
  assert.equal(behindAt(clock(false, 0), 1102), 0, "the clock of a simulation stands");
  assert.equal(behindAt(new Map(), 1102), 0);
});

test("times before now are seconds", () => {
  assert.equal(agoText(12.44), "12.4 s ago");
  assert.equal(agoText(123.4), "123 s ago");
  assert.equal(beforeText(-5, 0), "−5 s");
  assert.equal(beforeText(0), "now");
});

test("recordings of rules are named by time and cause", () => {
  assert.equal(savedText("2026-11-23_05-12-47_Scan_error"), "2026-11-23 05:12:47 · Scan error");
  assert.equal(savedText("mine"), "mine");
});

test("the server's clock stands still if all messages are equally fast", () => {
  let offset = null;
  for (let beat = 0; beat < 5; beat += 1) {
    offset = offsetAfter(offset, 0.25);
    assert.equal(offset, 0.25);
  }
});

test("the fastest message sets the server's clock, and a clock that was set counts at once", () => {
  assert.equal(offsetAfter(0.2, 0.25), 0.25);
  assert.ok(Math.abs(offsetAfter(0.25, 0.2) - 0.249) < 1e-9, "follows drift slowly");
  assert.equal(offsetAfter(0.25, -5), -5);
});
