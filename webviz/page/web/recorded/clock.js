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
  let [last, lastReport] = [0, 0]; // when it was looked, and when `tell` was called, in ms
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
    const position = positionAfter(state, passed, span());
    if (position === null) return pause(true);
    await showNext((state.position = position));
    if (now - lastReport >= TELL_MS) {
      lastReport = now;
      tell();
    }
    if (state.isPlaying) requestAnimationFrame(tick);
  }

  /** @param {boolean} isPaused */
  function pause(isPaused) {
    if (state.isPlaying === !isPaused) return;
    state.isPlaying = !isPaused;
    if (state.isPlaying) {
      if (!isWithin(state.position, span())) [state.position] = span();
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

/**
 * @param {number} position
 * @param {number[]} span
 */
const isWithin = (position, [first, end]) => position >= first && position < end;

/**
 * The position after some seconds of playing; null at the end.
 *
 * @param {Playing} state
 * @param {number} passed
 * @param {number[]} span
 */
function positionAfter({ position, loop, rate }, passed, [first, end]) {
  if (position < end) return Math.min(position + passed * (rate || 20), end);
  return loop && first < end ? first : null;
}
