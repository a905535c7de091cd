// The values of the points of large clouds, which a file has as arrays.

/** @import {ItemColumns, Numbers} from "./types.js" */
/** @import {Vec3} from "../types.js" */

/** The key of the columns among the values of a node. */
export const COLUMNS = "#columns";
const DIGITS = 9; // identify every float32

/**
 * A number as the viewer writes it: of a float32, the digits that identify it.
 *
 * @param {Numbers} numbers
 * @param {number} at
 */
function text(numbers, at) {
  const value = numbers[at];
  if (Number.isNaN(value)) return "nan";
  if (!Number.isFinite(value)) return value > 0 ? "inf" : "-inf";
  const isFloat = numbers instanceof Float32Array || numbers instanceof Float64Array;
  const short = String(numbers instanceof Float32Array ? shortest(value) : value);
  return isFloat && /^-?\d+$/.test(short) ? `${short}.0` : short;
}

/**
 * The shortest number that is a float32 once it is rounded.
 *
 * @param {number} value
 */
function shortest(value) {
  for (let digits = 1; digits < DIGITS; digits++) {
    const short = Number(value.toPrecision(digits));
    if (Math.fround(short) === value) return short;
  }
  return Number(value.toPrecision(DIGITS));
}

/**
 * Title and fields of an item, all texts; null if they were left out.
 *
 * @param {ItemColumns} columns
 * @param {number} item
 * @param {Vec3} at its place in the node
 */
export function columnDetails({ title, values, ids, position, origin }, item, at) {
  const columns = values.flatMap(([, value]) => (typeof value === "string" ? [] : [value.array]));
  if ([...columns, ...(ids ? [ids] : [])].some((array) => !array.length)) return null;
  /** @type {[string, string][]} */
  const fields = values.map(([name, value]) => {
    if (typeof value === "string") return [name, value];
    const parts = value.text.split("{}");
    const first = item * (parts.length - 1);
    const told = parts.slice(1).map((part, k) => text(value.array, first + k) + part);
    return [name, parts[0] + told.join("")];
  });
  const place = at.map((each, axis) => (each + origin[axis]).toFixed(4)).join(", ");
  fields.push([position, `${place} m`]);
  return { title: title.replace("{}", String(ids ? ids[item] : item)), fields };
}
