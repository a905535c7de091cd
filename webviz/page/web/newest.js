// Sending one value at a time: while one is under way, only the newest of the others is kept.

/**
 * Returns `{to(value), wanted()}`: `to` sends a value, `wanted` is the one that was asked for last, null
 * once it has arrived. `changed()` is called when that changes.
 *
 * @param {(value: number) => unknown} send
 * @param {() => void} [changed]
 */
export function newest(send, changed = () => {}) {
  /** @type {number | null} */
  let wanted = null;

  /** @param {number} value */
  async function to(value) {
    const isUnderway = wanted !== null;
    wanted = value;
    changed();
    if (isUnderway) return;
    let sent;
    while (sent !== wanted) {
      sent = wanted;
      await send(sent);
    }
    wanted = null;
    changed();
  }

  return { to, wanted: () => wanted };
}
