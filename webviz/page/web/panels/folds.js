// Rows that fold: Left closes a row or goes to the one around it, Right opens it.

import { indent } from "webviz/controls/rows.js";
import { el, set } from "webviz/dom.js";
import { icon } from "webviz/icons.js";

/** The mark of a row that folds, its first child. */
export const foldMark = () => el("span", { class: "wv-fold-mark" }, icon("chevron", 12));

/**
 * Shows how deep a row is in its tree, and whether it is open; null has nothing to fold.
 *
 * @param {HTMLElement} element with a `foldMark`
 * @param {{depth: number, isOpen: boolean | null}} row
 */
export function showFold(element, { depth, isOpen }) {
  const isLeaf = isOpen === null;
  set(element.children[0], { "data-open": isOpen ? "" : null, "data-none": isLeaf ? "" : null });
  set(element, { "aria-level": depth + 1, "aria-expanded": isLeaf ? null : String(isOpen) });
  indent(element, depth);
}

/**
 * Takes up a key on a row, and returns whether it was one of these.
 *
 * @template {{key: string, depth: number, isOpen: boolean | null}} R
 * @param {string} key
 * @param {R} row the key of each has those around it, in between the separator
 * @param {(row: R) => unknown} toggle
 * @param {{mark: (key: string) => unknown}} list
 * @param {string} separator
 */
export function foldByKey(key, row, toggle, list, separator = "/") {
  const isFold =
    (key === "ArrowLeft" && row.isOpen) || (key === "ArrowRight" && row.isOpen === false);
  if (isFold) toggle(row);
  else if (key === "ArrowLeft" && row.depth)
    list.mark(row.key.slice(0, row.key.lastIndexOf(separator)));
  return isFold || key === "ArrowLeft";
}
