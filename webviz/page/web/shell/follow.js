// The frame that the camera of this page follows.

import { act } from "webviz/act.js";

/** No frame to follow. */
export const FIXED = "<Fixed Frame>";

/**
 * Follows a frame, and centers it, since it may be far away; "" follows none.
 *
 * @param {string} frame
 */
export async function follow(frame) {
  const answer = await act("ChangeView", { key: "target_frame", value: frame || FIXED });
  if (answer.level === "ok" && frame && frame !== FIXED) act("FocusFrame", { frame });
  return answer;
}
