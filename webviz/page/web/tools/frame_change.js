// The fixed frame as tools see it: numbers of another one would be elsewhere.

import { watch } from "webviz/stores.js";

/**
 * Calls `act` whenever the fixed frame has become another one.
 *
 * @param {() => void} act
 */
export function onFrameChange(act) {
  /** @type {string | null | undefined} */
  let frame = null;
  watch("settings", (settings) => {
    const now = settings.get("fixed_frame");
    if (frame !== null && now !== frame) act();
    frame = now;
  });
}
