// Numbers as people write them, with a unit.

/** @import {DeclaredProperty} from "webviz/contents.js" */

/** @typedef {Pick<DeclaredProperty, "kind" | "low" | "above" | "high" | "below" | "unit">} NumberProperty */

// By the unit of the field: what others are worth in it.
/** @type {Record<string, Record<string, number>>} */
const UNITS = {
  m: { km: 1000, m: 1, dm: 0.1, cm: 0.01, mm: 0.001, µm: 1e-6, um: 1e-6, in: 0.0254, ft: 0.3048 },
  rad: { rad: 1, deg: Math.PI / 180, "°": Math.PI / 180, mrad: 0.001 },
  s: { h: 3600, min: 60, s: 1, ms: 1e-3, us: 1e-6, µs: 1e-6, ns: 1e-9 },
  Hz: { MHz: 1e6, kHz: 1000, Hz: 1, mHz: 0.001 },
  px: { px: 1 },
};
const NUMBER = /^([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*(.*)$/i;
const DECIMALS = 6;

/**
 * A number from what was typed into a field with a unit; throws a sentence if it means nothing.
 *
 * @param {string} text
 * @param {string} [unit]
 */
export function parse(text, unit) {
  const [, digits, suffix] = NUMBER.exec(text.trim().replace("−", "-")) ?? [];
  if (digits === undefined) throw new Error(`Not changed: ${quoted(text)} is not a number.`);
  const factor = factorOf(suffix.trim(), unit);
  if (factor === undefined) throw new Error(`Not changed: ${wrongUnit(suffix, unit)}`);
  const value = Number(digits) * factor;
  if (!Number.isFinite(value)) throw new Error(`Not changed: ${quoted(text)} is too large.`);
  return factor === 1 ? value : Number(value.toPrecision(12));
}

/**
 * @param {string} suffix
 * @param {string} [unit]
 * @returns {number | undefined}
 */
function factorOf(suffix, unit) {
  if (suffix === "" || suffix === unit) return 1;
  const factors = UNITS[unit ?? ""] ?? {};
  const names = Object.keys(factors);
  const exact = names.find((name) => name === suffix);
  return factors[exact ?? names.find((name) => same(name, suffix)) ?? ""];
}

/**
 * @param {string} a
 * @param {string} b
 */
const same = (a, b) => a.toLowerCase() === b.toLowerCase();

/**
 * @param {string} suffix
 * @param {string} [unit]
 */
function wrongUnit(suffix, unit) {
  if (!unit) return `expected a number without a unit, got ${quoted(suffix)}.`;
  const others = Object.keys(UNITS[unit] ?? { [unit]: 1 });
  return `${quoted(suffix)} is not a valid unit here; use ${others.join(", ")}.`;
}

/** @param {string} text */
function quoted(text) {
  return `“${text.length > 60 ? `${text.slice(0, 59)}…` : text}”`;
}

/**
 * A number as a field shows it: as short as it can be, with up to six decimals.
 *
 * @param {unknown} value
 */
export function format(value) {
  if (typeof value !== "number" || !Number.isFinite(value)) return "";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e15)) return String(Number(value.toPrecision(6)));
  return String(Number(value.toFixed(DECIMALS)));
}

/**
 * True for radians, and for radians per second.
 *
 * @param {string} [unit]
 */
export const isAngle = (unit) => unit?.startsWith("rad") ?? false;

/**
 * The unit of a number as it stands beside it; of an angle with its degrees, "rad (30°)".
 *
 * @param {string} unit
 * @param {unknown} value
 */
export function unitText(unit, value) {
  if (!isAngle(unit) || typeof value !== "number" || !Number.isFinite(value)) return unit;
  const degrees = Number(((value * 180) / Math.PI).toPrecision(4));
  return `${unit} (${degrees}${unit.replace("rad", "°")})`;
}

/**
 * The largest power of ten up to a size.
 *
 * @param {number} size
 */
const powerOfTen = (size) => Number(`1e${Math.floor(Math.log10(size))}`);

/**
 * The step of an arrow key from a value.
 *
 * @param {Pick<NumberProperty, "kind" | "low" | "high">} property
 * @param {number} value
 */
export function stepOf({ kind, low, high }, value) {
  if (kind === "int") return 1;
  if (low !== undefined && high !== undefined) return powerOfTen((high - low) / 100);
  return powerOfTen(Math.abs(value) / 10 || 0.1);
}

/**
 * The nearest value that the bounds of a property allow, rounded to a step.
 *
 * @param {NumberProperty} property
 * @param {number} value
 * @param {number} step
 */
export function within({ kind, low, above, high, below }, value, step) {
  const rounded =
    kind === "int" ? Math.round(value) : Number((Math.round(value / step) * step).toPrecision(12));
  if (low !== undefined && rounded < low) return low;
  if (high !== undefined && rounded > high) return high;
  if (above !== undefined && rounded <= above) return above + (kind === "int" ? 1 : step);
  if (below !== undefined && rounded >= below) return below - (kind === "int" ? 1 : step);
  return rounded;
}

/**
 * The bounds in words, "" without any.
 *
 * @param {Partial<NumberProperty>} property
 */
export function bounds({ low, above, high, below, unit }) {
  const least = low !== undefined ? `≥ ${low}` : above !== undefined ? `> ${above}` : "";
  const most = high !== undefined ? `≤ ${high}` : below !== undefined ? `< ${below}` : "";
  const isRange = low !== undefined && high !== undefined;
  const text = isRange ? `${low} to ${high}` : [least, most].filter(Boolean).join(", ");
  return text && unit ? `${text} ${unit}` : text;
}
