// Actions on the frame that is marked in the panel "TF"; features add to them.

import { signal } from "webviz/signals.js";

/** @import {Frame} from "webviz/contents.js" */

/**
 * @typedef {{
 *   label: string, tip: string, needs: string,
 *   isFor: (frame: Frame | null) => boolean, run: (name: string) => unknown,
 * }} FrameAction `needs` names the command of the viewer that it sends; a root has no `Frame`
 */

/** @type {FrameAction[]} */
export const frameActions = [];

/** @param {FrameAction} action */
export const frameAction = (action) => frameActions.push(action);

const frameToShow = signal(/** @type {string | null} */ (null));

/**
 * Marks a frame when the panel is shown.
 *
 * @param {string} name
 */
export const showFrame = (name) => void (frameToShow.value = name);

/** That frame, once; read in effects. */
export function wantedFrame() {
  const name = frameToShow.value;
  frameToShow.value = null;
  return name;
}
