// The number of points that this page draws 20 times a second, measured while it draws.

import { why } from "webviz/access.js";
import * as channel from "webviz/channel.js";
import constants from "webviz/constants.js";
import { signal } from "webviz/signals.js";
import * as viser from "webviz/viser_page.js";
import { whenDrawn } from "webviz/scene/graphics.js";

const { POINTS_HELD, FEWEST_POINTS, MAX_POINTS } = constants;
const GOAL_MS = 50;
// Between these the number stays: it goes in steps of two, which lead from neither to the other.
const SLOW_MS = 1.5 * GOAL_MS;
const FAST_MS = 0.5 * GOAL_MS;
const USED = 0.7; // of the points held, for a fast frame to say that there is room for more
const FRAMES = 5;
const PATIENCE_MS = 1500; // of a slow browser, fewer frames are enough

const limit = signal(POINTS_HELD);

/** The number of points to draw at once; read in effects. */
export const points = () => limit.value;

export function install() {
  let began = 0;
  let isMeasuring = false;
  let isMeasured = false;
  /** @type {{ms: number, pointCount: number}[]} */
  let frames = [];

  channel.onOpen(() => isMeasured && report());
  viser.beforeRender(() => (began = performance.now()));
  viser.afterRender(() => {
    const pointCount = viser.gl().info.render.points;
    if (isMeasuring || 2 * pointCount < FEWEST_POINTS || isHeld()) return;
    isMeasuring = true;
    const from = began;
    whenDrawn((isDrawn) => {
      const ms = performance.now() - from;
      isMeasuring = false;
      if (document.hidden || !isDrawn) return;
      frames.push({ ms, pointCount });
      const all = frames.reduce((sum, frame) => sum + frame.ms, 0);
      if (frames.length < FRAMES && all < PATIENCE_MS) return;
      const count = countAfter(frames);
      frames = [];
      if (count === limit.value && isMeasured) return;
      limit.value = count;
      isMeasured = true;
      report();
      viser.requestRender();
    });
  });
}

/**
 * The number of points to draw from now on.
 *
 * @param {{ms: number, pointCount: number}[]} frames
 */
function countAfter(frames) {
  const times = frames.map(({ ms }) => ms).sort((a, b) => a - b);
  const ms = times[times.length >> 1];
  const pointCount = Math.max(...frames.map((frame) => frame.pointCount));
  const before = limit.value;
  if (ms > SLOW_MS) return stepBelow((Math.min(pointCount, before) * GOAL_MS) / ms);
  return ms < FAST_MS && pointCount > USED * before ? stepBelow(2 * before) : before;
}

/** @param {number} count */
function stepBelow(count) {
  const step = FEWEST_POINTS * 2 ** Math.floor(Math.log2(count / FEWEST_POINTS));
  return Math.min(Math.max(step, FEWEST_POINTS), MAX_POINTS);
}

// Reports of watchers would change what others see.
const report = () =>
  why("PointCapacity") || channel.send({ type: "PointCapacity", points: limit.value });

// Pages that only take pictures draw on request; those must not depend on how fast that is.
const isHeld = () => viser.canvas().style.visibility === "hidden";
