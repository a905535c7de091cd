// Seeks, one at a time: while the scene is on its way to one, only the newest of the others is kept.

import { act } from "../act.js";
import { returnToLive } from "./rewound.js";

/** @typedef {ReturnType<typeof seeks>} Seeks */

/**
 * Returns `{to(time), wanted()}`: `to` shows a time of the recording, `wanted` is the one that was asked
 * for last, null once the scene shows it. `changed()` is called when that changes.
 *
 * @param {() => void} changed
 * @param {(time: number) => boolean} isNow whether a time is that of live topics
 */
export function seeks(changed, isNow = () => false) {
  let underway = false;
  /** @type {number | null} */
  let wanted = null;

  /** @param {number} time */
  async function to(time) {
    wanted = time;
    changed();
    if (underway) return;
    underway = true;
    /** @type {number | null} */
    let sent = null;
    while (sent !== wanted) {
      sent = wanted;
      await (isNow(sent) ? returnToLive() : act("Seek", { at_s: sent }));
    }
    underway = false;
    wanted = null;
    changed();
  }

  return { to, wanted: () => wanted };
}
