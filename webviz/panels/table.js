// The widget "table": rows that are sorted by a click on a column.

import { rowList, touchable } from "webviz/controls/rows.js";
import { csvText } from "webviz/csv.js";
import { el } from "webviz/dom.js";
import { download } from "webviz/download.js";
import { iconButton } from "webviz/icons.js";
import { NAMED } from "webviz/panels/message_tree.js";
import { batch, computed, effect, signal } from "webviz/signals.js";

/** @import {Readable, Signal} from "../page/web/signals.js" */
/** @import {Page} from "../page/web/extensions.js" */

/** @typedef {{key: string, cells: (number | string)[]}} Row */

const ROW_PX = 22;
const LETTERS = [6, 40]; // of a column that are reserved
const SAMPLE = 50; // rows that its width follows from
const UNSORTED = { column: -1, isUp: true };

/** @param {Page} page */
export default function install({ widget }) {
  widget("table", table);
}

function table() {
  const latest = signal({ rows: /** @type {Row[]} */ ([]), note: "", problem: "" });
  const columns = signal(/** @type {string[]} */ ([]));
  const sorting = signal(UNSORTED);
  const rows = computed(() => sorted(latest.value.rows, sorting.value));
  const host = el("div", { class: "wv-table" });
  const list = rowList({
    label: "Table",
    role: "grid",
    rowRole: "row",
    height: touchable(ROW_PX),
    row: rowOf,
    host,
  });
  host.append(head(columns, sorting), list.element);
  effect(() => list.show(rows.value));
  effect(() => {
    const widths = columns.value.map((name, column) => widthOf(latest.value.rows, name, column));
    const least = widths.reduce((sum, width) => sum + width, 0);
    const all = widths.map((width) => `minmax(${width}ch, ${width}fr)`);
    host.style.setProperty("--wv-columns", all.join(" "));
    host.style.setProperty("--wv-least", `calc(${least}ch + ${8 * widths.length}px)`);
  });
  const problem = () => latest.value.problem;
  const note = () => [`${latest.value.rows.length} rows`, latest.value.note].filter(Boolean);
  const save = () =>
    download("table.csv", csvText([columns.value, ...latest.value.rows.map(({ cells }) => cells)]));
  return {
    element: el(
      "div",
      { class: "wv-plugin-fill" },
      el("div", { class: "wv-empty", role: "status", hidden: () => !problem() }, problem),
      host,
    ),
    head: el(
      "span",
      { class: "wv-panel-tools" },
      el("span", { class: "wv-quiet" }, () => note().join(", ")),
      iconButton("download", "Download as CSV", save),
    ),
    /** @param {{columns?: string[], rows?: Row["cells"][], note?: string, problem?: string}} values */
    update: (values) =>
      batch(() => {
        const names = values.columns ?? [];
        if (JSON.stringify(columns.value) !== JSON.stringify(names)) {
          columns.value = names;
          sorting.value = UNSORTED;
        }
        const all = (values.rows ?? []).map((cells, i) => ({ key: String(i), cells }));
        latest.value = { rows: all, note: values.note ?? "", problem: values.problem ?? "" };
      }),
  };
}

/**
 * The names of the columns, by which rows are sorted.
 *
 * @param {Readable<string[]>} columns
 * @param {Signal<typeof UNSORTED>} sorting
 */
function head(columns, sorting) {
  /** @param {number} column */
  const sort = (column) => {
    const { column: before, isUp } = sorting.value;
    sorting.value = { column, isUp: before === column ? !isUp : true };
  };
  /** @param {number} column */
  const state = (column) => {
    if (column !== sorting.value.column) return null;
    return sorting.value.isUp ? "ascending" : "descending";
  };
  return el("div", { class: "wv-table-row", role: "row" }, () =>
    columns.value.map((name, i) =>
      el(
        "button",
        {
          type: "button",
          role: "columnheader",
          class: "wv-ellipsis",
          "aria-sort": () => state(i),
          onclick: () => sort(i),
        },
        name,
      ),
    ),
  );
}

/** @param {() => Row} row */
const rowOf = (row) =>
  el("div", { class: "wv-table-row" }, () =>
    row().cells.map((cell) =>
      el("span", { class: "wv-ellipsis wv-number", role: "gridcell" }, textOf(cell)),
    ),
  );

/** @param {number | string} cell */
const textOf = (cell) =>
  typeof cell === "number" && !Number.isInteger(cell)
    ? String(Number.parseFloat(cell.toPrecision(6)))
    : String(cell);

/** @param {number | string} cell */
function numberOf(cell) {
  const number = typeof cell === "number" ? cell : NAMED.exec(cell)?.[2];
  return number === undefined ? null : Number(number);
}

/**
 * @param {Row[]} rows
 * @param {typeof UNSORTED} sorting
 */
function sorted(rows, { column, isUp }) {
  if (column < 0) return rows;
  const order = isUp ? 1 : -1;
  return rows.toSorted((a, b) => order * compare(a.cells[column], b.cells[column]));
}

/**
 * @param {number | string} a
 * @param {number | string} b
 */
function compare(a, b) {
  const [x, y] = [numberOf(a), numberOf(b)];
  return x !== null && y !== null ? x - y : String(a).localeCompare(String(b));
}

/**
 * The letters that a column needs.
 *
 * @param {Row[]} rows
 * @param {string} name
 * @param {number} column
 */
function widthOf(rows, name, column) {
  const texts = rows.slice(0, SAMPLE).map(({ cells }) => textOf(cells[column] ?? "").length);
  return Math.min(LETTERS[1], Math.max(LETTERS[0], name.length + 2, ...texts));
}
