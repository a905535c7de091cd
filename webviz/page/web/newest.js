// Sending one value at a time: while one is under way, only the newest of the others is kept.

import { signal, untracked } from "webviz/signals.js";

/**
 * Returns `{to(value), wanted()}`: `to` sends a value, `wanted` is the one that was asked for last, null
 * once it has arrived; it is read in effects.
 *
 * @param {(value: number) => unknown} send
 */
export function newest(send) {
  const target = signal(/** @type {number | null} */ (null));
  const current = () => untracked(() => target.value);

  /** @param {number} value */
  async function to(value) {
    const isUnderway = current() !== null;
    target.value = value;
    if (isUnderway) return;
    let last = null;
    for (let next = current(); next !== null && next !== last; next = current()) {
      last = next;
      await send(next);
    }
    target.value = null;
  }

  return { to, target: () => target.value };
}
