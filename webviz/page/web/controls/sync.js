// Keeps a control and a value of the viewer the same.
//
// The control shows what the viewer has. What is entered is sent; until the viewer has taken it
// over, it sends older values, which must not set the control back under the hand. So what comes from
// outside waits during an edit, and a moment longer; then the newest is shown.

import { effect, untracked } from "webviz/signals.js";

/** @import {Mixed} from "webviz/controls/mixed.js" */
/** @import {Outcome} from "webviz/types.js" */

const SETTLE_MS = 500;
const ANSWER_MS = 8000; // then it was lost with the connection
const NO_ANSWER = { level: "error", text: "Not changed: the viewer does not answer. Try again." };

/**
 * `value()` is read in an effect: what the viewer has, undefined before that is known. `show(value)`
 * makes the control show it. `change(value)` sends another to the viewer; it may return a promise of
 * `{level, text}`. `refused(text)` says why the viewer did not take it, or "" that all is well. A refused value stays for correction; once the control has lost the focus (`isFocused()`),
 * until another page changes the value.
 *
 * @template T
 * @param {{
 *   value: () => T | Mixed | undefined, show(value: T | Mixed): void, change: (value: T) => unknown,
 *   refused?: (text: string) => void, isFocused?: () => boolean,
 * }} control
 */
export function sync({ value, show, change, refused = () => {}, isFocused = () => false }) {
  /** @type {T | Mixed | undefined} */
  let newest;
  let isHeld = false;
  let isRefused = false;
  const settling = pause(SETTLE_MS, showNewest);
  const sending = sender(change, (answer) => {
    showError(answer?.level === "error" ? answer.text : "");
    if (!isRefused) settling.start();
  });

  /** @param {string} text */
  function showError(text) {
    isRefused = text !== "";
    refused(text);
  }

  /** @param {T | Mixed} value that the viewer has */
  function take(value) {
    const isOther = newest !== undefined && JSON.stringify(value) !== JSON.stringify(newest);
    if (isOther && isRefused && !isHeld && !isFocused()) showError("");
    newest = value;
    showNewest();
  }

  function showNewest() {
    const isBusy = isHeld || isRefused || sending.isUnderWay() || settling.isOn();
    if (!isBusy && newest !== undefined) show(newest);
  }

  effect(() => {
    const now = value();
    if (now !== undefined) untracked(() => take(now));
  });
  return {
    /** Typing or dragging begins. */
    hold() {
      isHeld = true;
    },
    /** They have ended. */
    release() {
      isHeld = false;
      settling.start();
    },
    /** They entered a value. */
    edit: sending.send,
    /** Report invalid input, and leave it for correction. */
    refuse: showError,
    /** Back to what the viewer has, or is about to have. */
    cancel() {
      isHeld = false;
      if (isRefused) showError("");
      showNewest();
    },
  };
}

/**
 * Sends one value at a time: of a drag, the viewer gets as many as it can take. `done` is called with
 * the answer to the last one.
 *
 * @template T
 * @param {(value: T) => unknown} change
 * @param {(answer: Outcome | undefined) => void} onAnswer
 */
function sender(change, onAnswer) {
  let isUnderWay = false;
  /** @type {{value: T} | null} */
  let waiting = null;

  /** @param {T} value */
  async function next(value) {
    isUnderWay = true;
    const timeout = new Promise((resolve) => setTimeout(resolve, ANSWER_MS, NO_ANSWER));
    const answer = /** @type {Outcome | undefined} */ (
      await Promise.race([change(value), timeout])
    );
    isUnderWay = false;
    if (!waiting) return onAnswer(answer);
    const newer = waiting;
    waiting = null;
    next(newer.value);
  }

  return {
    isUnderWay: () => isUnderWay,
    /** @param {T} value */
    send(value) {
      if (isUnderWay) waiting = { value };
      else next(value);
    },
  };
}

/**
 * A pause that `start()` begins anew; `done` is called at its end.
 *
 * @param {number} milliseconds
 * @param {() => void} onEnd
 */
function pause(milliseconds, onEnd) {
  /** @type {ReturnType<typeof setTimeout> | 0} */
  let timer = 0;
  return {
    isOn: () => timer !== 0,
    start() {
      clearTimeout(timer);
      timer = setTimeout(() => {
        timer = 0;
        onEnd();
      }, milliseconds);
    },
  };
}
