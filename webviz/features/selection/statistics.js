// Statistics of the selection: how many things of each display, and the range of their values.

/** @import {DisplayShare, ValueRange} from "webviz/contents.js" */
/** @import {MessageRow} from "webviz/panels/message_tree.js" */

const DIGITS = 3; // of how far values extend
const MAX_DECIMALS = 9;

/**
 * Rows of the panel "Selection" for what the server has told of displays; `folds` as there.
 *
 * @param {DisplayShare[]} displays
 * @param {Map<string, boolean>} folds
 * @returns {(MessageRow & {isStatistics?: boolean})[]}
 */
export function statisticsRows(displays, folds) {
  return displays.flatMap(({ name, count, ranges }, index) => {
    const key = `statistics ${index}`;
    const isOpen = ranges.length ? (folds.get(key) ?? true) : null;
    const row = { key, depth: 0, name, value: `${count} selected`, isOpen, isStatistics: true };
    const rows = ranges.map((range) => ({
      key: `${key}/${range.name}`,
      depth: 1,
      name: range.name,
      value: words(range),
      isOpen: null,
    }));
    return isOpen ? [row, ...rows] : [row];
  });
}

/**
 * The same as text.
 *
 * @param {DisplayShare[]} displays
 */
export const statisticsText = (displays) =>
  displays
    .map(({ name, count, ranges }) =>
      [
        `${name}: ${count} selected`,
        ...ranges.map((range) => `  ${range.name}: ${words(range)}`),
        "",
      ].join("\n"),
    )
    .join("");

/**
 * A value among others that extend so far: positions far away must not lose what tells them apart.
 *
 * @param {number} value
 * @param {number} extent
 */
function rounded(value, extent) {
  const decimals = extent > 0 ? DIGITS - 1 - Math.floor(Math.log10(extent)) : 0;
  return String(Number(value.toFixed(Math.max(0, Math.min(decimals, MAX_DECIMALS)))));
}

/** @param {ValueRange} range */
function words({ unit, low, high, mean }) {
  const [from, to, middle] = [low, high, mean].map((value) =>
    rounded(value, high - low || Math.abs(mean)),
  );
  return `${from} to ${to}, mean ${middle}${unit && ` ${unit}`}`;
}
