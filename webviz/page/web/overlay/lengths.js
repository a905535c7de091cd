// Round lengths, and their texts.

/** @type {[string, number][]} */
const UNITS = [
  ["km", 1000],
  ["m", 1],
  ["cm", 0.01],
  ["mm", 0.001],
];

/**
 * The largest of 1, 2 and 5 times a power of ten up to a length.
 *
 * @param {number} length
 */
export function rounded(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return ([5, 2, 1].find((digit) => digit * power <= length) ?? 1) * power;
}

/**
 * A length in metres in the unit that suits it.
 *
 * @param {number} meters
 */
export function inWords(meters) {
  const [unit, size] = UNITS.find(([, size]) => meters >= size * 0.9999) ?? UNITS[UNITS.length - 1];
  return `${Number((meters / size).toPrecision(3))} ${unit}`;
}
