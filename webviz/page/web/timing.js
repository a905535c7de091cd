// Calls that wait: for the last of several, for the next frame, or for a time.

import { owned } from "webviz/signals.js";

/**
 * Returns a function that calls `run` once it has not been called itself for some time.
 *
 * @param {() => unknown} run
 * @param {number} ms
 */
export function debounced(run, ms) {
  let timer = 0;
  return () => {
    clearTimeout(timer);
    timer = setTimeout(run, ms);
  };
}

/**
 * Returns a function that calls `run` before the next frame that the browser draws, once however often
 * it is called until then.
 *
 * @param {() => unknown} run
 */
export function oncePerFrame(run) {
  let frame = 0;
  return () => {
    frame ||= requestAnimationFrame(() => {
      frame = 0;
      run();
    });
  };
}

/**
 * Calls `run` every so many milliseconds, until what this is called in ends.
 *
 * @param {number} ms
 * @param {() => unknown} run
 */
export function every(ms, run) {
  const timer = setInterval(run, ms);
  owned(() => clearInterval(timer));
}
