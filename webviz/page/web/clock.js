// The viewer's time, counted here: the server says how it runs only when that changes.

import * as channel from "webviz/channel.js";
import { offsetAfter } from "webviz/clock_offset.js";
import { signal, untracked } from "webviz/signals.js";
import { watch } from "webviz/stores.js";

/** @import {ValuesOf} from "webviz/types.js" */

// Of the server's clock over that of this browser, in seconds.
const ahead = signal(/** @type {number | null} */ (null));

channel.on("Heartbeat", ({ wall }) => {
  ahead.value = offsetAfter(ahead.value, wall - Date.now() / 1000);
});

/** Wall time of the server in seconds. */
export const wallNow = () => Date.now() / 1000 + (untracked(() => ahead.value) ?? 0);

/**
 * ROS time in seconds by the store "clock", a Map.
 *
 * @param {ValuesOf<"clock">} clock
 */
export function rosNow(clock) {
  const [ros, wall, rate] = clock.get("pace");
  return rate ? ros + (wallNow() - wall) * rate : ros;
}

/**
 * Calls `show(clock)` when the store "clock" changes, and every `period` ms. Returns what ends it.
 *
 * @param {number} period
 * @param {(clock: ValuesOf<"clock">) => void} show
 */
export function watchTime(period, show) {
  /** @type {ValuesOf<"clock"> | null} */
  let clock = null;
  const tick = () => {
    if (clock && !document.hidden) show(clock);
  };
  const end = watch("clock", (values) => {
    clock = values;
    tick();
  });
  const timer = setInterval(tick, period);
  return () => {
    clearInterval(timer);
    end();
  };
}
