// The borders of the rows of panels, and those between panels: dragged for other sizes.

import { shared, sized } from "webviz/docks/places.js";
import { splitter } from "webviz/docks/splitter.js";
import { arrange, layout } from "webviz/docks/state.js";

/** @type {Map<string, HTMLElement>} */
const splitters = new Map();

/**
 * The border between a row of panels and the scene; `size` is that of the row.
 *
 * @param {"x" | "y"} along
 * @param {"width" | "height"} key
 * @param {string} label
 * @param {() => number} size
 */
export const border = (along, key, label, size) =>
  splitter({
    label,
    along: () => along,
    size,
    move: (pixels, before) => (layout.value = sized(layout.value, key, before - pixels)),
    end: () => arrange(layout.value),
  });

/**
 * The border between two neighbours of a row, by the first panels of their places.
 *
 * @param {"beside" | "below"} row
 * @param {string} panel
 * @param {string} next
 */
export function between(row, panel, next) {
  const key = JSON.stringify([row, panel, next]);
  const border = splitters.get(key) ?? make(row, panel, next);
  splitters.set(key, border);
  return border;
}

/**
 * @param {"beside" | "below"} row
 * @param {string} panel
 * @param {string} next
 */
function make(row, panel, next) {
  const size = row === "beside" ? "offsetHeight" : "offsetWidth";
  /** @param {"previousElementSibling" | "nextElementSibling"} side */
  const length = (side) => /** @type {HTMLElement | null} */ (border[side])?.[size] ?? 0;
  const border = splitter({
    label: "Size of the panels",
    along: () => (row === "beside" ? "y" : "x"),
    size: () => length("previousElementSibling"),
    move(pixels, before) {
      const both = length("previousElementSibling") + length("nextElementSibling");
      if (both) layout.value = shared(layout.value, row, panel, next, (before + pixels) / both);
    },
    end: () => arrange(layout.value),
  });
  return border;
}
