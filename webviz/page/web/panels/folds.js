// Rows that fold: Left closes a row or goes to the one around it, Right opens it.

/**
 * Takes up a key on a row, and returns whether it was one of these.
 *
 * @template {{key: string, depth: number, isOpen: boolean | null}} R
 * @param {string} key
 * @param {R} row the key of each has those around it, separated by "/"
 * @param {(row: R) => unknown} toggle
 * @param {{mark: (key: string) => unknown}} list
 */
export function foldByKey(key, row, toggle, list) {
  const isFold =
    (key === "ArrowLeft" && row.isOpen) || (key === "ArrowRight" && row.isOpen === false);
  if (isFold) toggle(row);
  else if (key === "ArrowLeft" && row.depth) list.mark(row.key.slice(0, row.key.lastIndexOf("/")));
  return isFold || key === "ArrowLeft";
}
