// The offset of the server's clock to that of this browser, by messages that took unknown times.

const DRIFT_S = 0.001; // that clocks may drift apart between two messages
const SET_S = 1; // more than that, and a clock was set

/**
 * The offset in seconds after one more message: a message that took longer makes the server's clock
 * seem slower, so the greatest is right.
 *
 * @param {number | null} previous the offset so far, null at first
 * @param {number} sample the server's time in the message, over that of this browser when it arrived
 */
export const offsetAfter = (previous, sample) =>
  previous === null || previous - sample > SET_S ? sample : Math.max(sample, previous - DRIFT_S);
