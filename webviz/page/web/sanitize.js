// Untrusted texts: names, topics and sentences may hold anything at all.

// Control characters, line ends, marks that turn the direction of what follows, halves of pairs.
const UNREADABLE =
  /[\u0000-\u001f\u007f-\u009f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]/gu;

/**
 * A text as one line that is read from left to right, cut if it is endless.
 *
 * @param {string} text
 * @param {number} [length]
 */
export function sanitized(text, length = 300) {
  const short = text.length <= length ? text : `${text.slice(0, length - 1)}…`;
  return short.replace(UNREADABLE, " ");
}
