// Rates, amounts and delays, with few digits.

const BYTES = ["B/s", "kB/s", "MB/s", "GB/s"];

/**
 * A rate in Hz; "" for none.
 *
 * @param {number} [hz]
 */
export const rateText = (hz) =>
  hz === undefined ? "" : `${hz < 100 ? hz.toFixed(1) : hz.toFixed(0)} Hz`;

/**
 * Bytes in a second.
 *
 * @param {number} [bytes]
 */
export function bytesText(bytes) {
  if (bytes === undefined) return "";
  let [size, unit] = [bytes, 0];
  while (size >= 1000 && unit < BYTES.length - 1) [size, unit] = [size / 1000, unit + 1];
  return `${size.toFixed(unit === 0 || size >= 100 ? 0 : 1)} ${BYTES[unit]}`;
}

/**
 * Seconds as a time in the unit that suits it: 12 ms, 3.4 s, 5 min; "" for none.
 *
 * @param {number | null} [seconds]
 */
export function spanText(seconds) {
  if (seconds === null || seconds === undefined) return "";
  const size = Math.abs(seconds);
  const sign = seconds < 0 ? "−" : "";
  if (size < 0.9995) return `${sign}${Math.round(size * 1000)} ms`;
  if (size < 9.95) return `${sign}${size.toFixed(1)} s`;
  if (size < 120) return `${sign}${size.toFixed(0)} s`;
  if (size < 7200) return `${sign}${Math.round(size / 60)} min`;
  return size < 172_800
    ? `${sign}${Math.round(size / 3600)} h`
    : `${sign}${Math.round(size / 86_400)} d`;
}

/**
 * Bytes of one message.
 *
 * @param {number} bytes
 */
export const sizeText = (bytes) => bytesText(bytes).replace("/s", "");
