// Seeks, one at a time.

import { act } from "../../act.js";
import { newest } from "../../newest.js";
import { returnToLive } from "./rewound.js";

/** @typedef {ReturnType<typeof seeks>} Seeks */

/**
 * Returns `{to(time), wanted()}`, as of `newest.js`: `to` shows a time of the recording.
 *
 * @param {() => void} changed
 * @param {(time: number) => boolean} isNow whether a time is that of live topics
 */
export const seeks = (changed, isNow = () => false) =>
  newest((time) => (isNow(time) ? returnToLive() : act("Seek", { at_s: time })), changed);
