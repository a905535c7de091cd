// Plays a recorded run: position, rate and span, as the viewer plays a bag.

/** @import {Playing} from "webviz/recorded/types.js" */

const TELL_MS = 100;

/**
 * Returns `{state(), seek(at), pause(isPaused), set(changes)}`. `show(at)` shows a time, and resolves
 * when the next one can be shown; `tell()` is called when something has changed.
 *
 * @param {number} duration
 * @param {(at: number) => Promise<void>} show
 * @param {() => void} tell
 */
export function clock(duration, show, tell) {
  /** @type {Playing} */
  const state = { position: 0, isPlaying: false, rate: 1, loop: false, selected: null };
  let last = 0;
  let told = 0;
  /** @type {Promise<void>} */
  let showing = Promise.resolve();

  const span = () => state.selected ?? [0, duration];

  /** @param {number} at */
  function showNext(at) {
    showing = showing.then(() => show(at));
    return showing;
  }

  async function tick() {
    if (!state.isPlaying) return;
    const now = performance.now();
    const passed = Math.min((now - last) / 1000, 0.25); // slower where drawing is slow
    last = now;
    const [first, end] = span();
    if (state.position >= end) {
      if (!state.loop || first >= end) return pause(true);
      state.position = first;
    } else state.position = Math.min(state.position + passed * (state.rate || 20), end);
    await showNext(state.position);
    if (now - told >= TELL_MS) {
      told = now;
      tell();
    }
    if (state.isPlaying) requestAnimationFrame(tick);
  }

  /** @param {boolean} isPaused */
  function pause(isPaused) {
    if (state.isPlaying === !isPaused) return;
    state.isPlaying = !isPaused;
    if (state.isPlaying) {
      const [first, end] = span();
      if (state.position < first || state.position >= end) state.position = first;
      last = performance.now();
      requestAnimationFrame(tick);
    }
    tell();
  }

  /** @param {number} at */
  async function seek(at) {
    state.position = Math.min(Math.max(at, 0), duration);
    await showNext(state.position);
    tell();
  }

  return {
    state: () => state,
    seek,
    pause,
    /** @param {Partial<Playing>} changes */
    set(changes) {
      Object.assign(state, changes);
      tell();
    },
  };
}
