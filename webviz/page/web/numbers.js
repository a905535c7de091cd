// Numbers as tools show them.

/**
 * A number with so many digits after its point; what is rounded to zero has no sign.
 *
 * @param {number} number
 * @param {number} digits
 */
export const fixed = (number, digits) => number.toFixed(digits).replace(/^-(0\.?0*)$/, "$1");

/** Returns a function that counts its calls, from 1. */
export function counter() {
  let count = 0;
  return () => (count += 1);
}
