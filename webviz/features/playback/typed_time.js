// Typed times of a recording.

const CLOCK = /^(?:(?:(\d+):)?(\d{1,2}):)?(\d{1,2}(?:\.\d*)?)$/;
const DATE = /^\d{4}-\d{2}-\d{2}[ T]\d{2}:\d{2}/;

/**
 * @param {string} text
 * @param {string} text
 */
export const isDate = (text) => DATE.test(text.trim());

/**
 * Seconds from the start of a recording: of "12.4", "1:12", "1:02:03.4", or of a date with time of
 * day, in the time zone of this browser unless it names one. Null if it is none of these.
 *
 * @param {string} text
 * @param {number} start of the recording, in seconds since 1970.
 * @param {string} text
 * @param {number} start
 */
export function parseTime(text, start) {
  const trimmed = text.trim();
  if (DATE.test(trimmed)) {
    const ms = Date.parse(trimmed.replace(" ", "T"));
    return Number.isNaN(ms) ? null : ms / 1000 - start;
  }
  if (/^\d+(\.\d*)?$/.test(trimmed)) return Number(trimmed);
  const match = CLOCK.exec(trimmed);
  if (!match) return null;
  const [, hours = "0", minutes = "0", seconds] = match;
  return Number(hours) * 3600 + Number(minutes) * 60 + Number(seconds);
}
