// Tables as CSV, which programs for spreadsheets open.

/**
 * A cell. Texts come from others, and spreadsheets compute those that begin like a formula.
 *
 * @param {number | string} cell
 */
function quoted(cell) {
  if (typeof cell === "number") return String(cell);
  const isFormula = /^\s*[=+\-@]/.test(cell) && !Number.isFinite(Number(cell));
  const text = isFormula ? `'${cell}` : cell;
  return `"${text.replaceAll('"', '""')}"`;
}

/**
 * Rows as CSV, a line for each.
 *
 * @param {(number | string)[][]} rows
 */
export function csvText(rows) {
  return rows.map((cells) => `${cells.map(quoted).join(",")}\n`).join("");
}
