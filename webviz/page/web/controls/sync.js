// Keeps a control and a value of the viewer the same.
//
// The control shows what the viewer has. What is entered is sent; until the viewer has taken it
// over, it sends older values, which must not set the control back under the hand. So what comes from
// outside waits during an edit, and a moment longer; then the newest is shown.

/** @import {Mixed} from "./mixed.js" */
/** @import {Outcome} from "../types.js" */

const SETTLE_MS = 500;
const ANSWER_MS = 8000; // then it was lost with the connection
const LOST = { level: "error", text: "Not changed: the viewer does not answer. Try again." };

/**
 * `show(value)` makes the control show a value. `send(value)` sends it to the viewer; it may return a
 * promise of `{level, text}`. `refused(text)` says why the viewer did not take it, or "" that all is
 * well. A refused value stays for correction; once the control has lost the focus (`isFocused()`),
 * until somebody else changes the value.
 *
 * @template T
 * @param {{
 *   show(value: T | Mixed): void, send: (value: T) => unknown, refused?: (text: string) => void,
 *   isFocused?: () => boolean,
 * }} control
 */
export function sync({ show, send, refused = () => {}, isFocused = () => false }) {
  /** @type {T | Mixed | undefined} */
  let newest;
  let hasNewest = false;
  let isHeld = false;
  let isRefused = false;
  let timer = 0;
  let isUnderWay = false;
  /** @type {{value: T} | null} */
  let waiting = null;

  const isBusy = () => isHeld || isRefused || isUnderWay || timer !== 0;

  function settle() {
    clearTimeout(timer);
    timer = setTimeout(() => {
      timer = 0;
      if (!isBusy() && hasNewest) show(/** @type {T | Mixed} */ (newest));
    }, SETTLE_MS);
  }

  /** @param {string} text */
  function tell(text) {
    isRefused = text !== "";
    refused(text);
  }

  /**
   * One at a time: of a drag, the viewer gets as many values as it can take.
   *
   * @param {T} value
   */
  async function next(value) {
    isUnderWay = true;
    const lost = new Promise((resolve) => setTimeout(resolve, ANSWER_MS, LOST));
    const answer = /** @type {Outcome | undefined} */ (await Promise.race([send(value), lost]));
    isUnderWay = false;
    if (waiting) {
      const { value } = waiting;
      waiting = null;
      next(value);
    } else {
      tell(answer?.level === "error" ? answer.text : "");
      if (!isRefused) settle();
    }
  }

  return {
    /**
     * The value that the viewer has.
     *
     * @param {T | Mixed} value
     */
    show(value) {
      const isOther = hasNewest && JSON.stringify(value) !== JSON.stringify(newest);
      if (isOther && isRefused && !isHeld && !isFocused()) tell("");
      newest = value;
      hasNewest = true;
      if (!isBusy()) show(value);
    },
    /** Typing or dragging begins. */
    hold() {
      isHeld = true;
    },
    /** They have ended. */
    release() {
      isHeld = false;
      settle();
    },
    /**
     * They entered a value.
     *
     * @param {T} value
     */
    edit(value) {
      if (isUnderWay) waiting = { value };
      else next(value);
    },
    /** Report invalid input, and leave it for correction. */
    refuse: tell,
    /** Back to what the viewer has, or is about to have. */
    cancel() {
      isHeld = false;
      if (isRefused) tell("");
      if (!isBusy() && hasNewest) show(/** @type {T | Mixed} */ (newest));
    },
  };
}
