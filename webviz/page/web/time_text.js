// Times as text.

const YEAR_S = 31_536_000;

/**
 * @param {number} number
 * @param {number} [digits]
 */
const pad = (number, digits = 2) => String(number).padStart(digits, "0");

/**
 * Date and time of day here of a time in seconds since 1970, with milliseconds if wanted. Simulations
 * count from zero: a time of the first year is hours, minutes and seconds.
 *
 * @param {number} seconds
 * @param {boolean} [precise]
 */
export function timeOfDay(seconds, precise = false) {
  const ms = Math.floor(seconds * 1000);
  const rest = precise ? `.${pad(((ms % 1000) + 1000) % 1000, 3)}` : "";
  if (Math.abs(seconds) < YEAR_S) return duration(seconds, 0) + rest;
  const date = new Date(ms);
  if (Number.isNaN(date.getTime())) return `${seconds.toFixed(0)} s`;
  const day = [date.getFullYear(), pad(date.getMonth() + 1), pad(date.getDate())].join("-");
  const time = [date.getHours(), date.getMinutes(), date.getSeconds()].map((n) => pad(n)).join(":");
  return `${day} ${time}${rest}`;
}

/**
 * Hours, minutes and seconds of a time in seconds: 1:02:03.4.
 *
 * @param {number} seconds
 * @param {number} [digits]
 */
export function duration(seconds, digits = 1) {
  const unit = 10 ** digits;
  const total = Math.floor(Math.abs(seconds) * unit + 1e-6);
  const whole = Math.floor(total / unit);
  const [h, m, s] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  const rest = digits ? `.${pad(total % unit, digits)}` : "";
  return `${seconds < 0 && total ? "−" : ""}${h}:${pad(m)}:${pad(s)}${rest}`;
}

/**
 * Time and cause of a recording that a rule made, by the name of its folder, which begins with the time.
 *
 * @param {string} name
 */
export function savedText(name) {
  const match = /^(\d{4}-\d\d-\d\d)_(\d\d)-(\d\d)-(\d\d)_(.*)$/.exec(name);
  if (!match) return name;
  const [, date, hours, minutes, seconds, cause] = match;
  return `${date} ${hours}:${minutes}:${seconds} · ${cause.replaceAll("_", " ")}`;
}
