// The widget "table": rows that are sorted by a click on a column.

import { rowList, touchable } from "webviz/controls/rows.js";
import { csvText } from "webviz/csv.js";
import { el, setText, showText } from "webviz/dom.js";
import { download } from "webviz/download.js";
import { iconButton } from "webviz/icons.js";
import { NAMED } from "webviz/panels/message_tree.js";

/** @import {Page} from "../page/web/extensions.js" */

/** @typedef {{key: string, cells: (number | string)[]}} Row */

const ROW_PX = 22;
const LETTERS = [6, 40]; // of a column that are reserved
const SAMPLE = 50; // rows that its width follows from

/** @param {Page} page */
export default function install({ widget }) {
  /** @param {number | string} cell */
  const textOf = (cell) =>
    typeof cell === "number" && !Number.isInteger(cell)
      ? String(Number.parseFloat(cell.toPrecision(6)))
      : String(cell);

  /** @param {number | string} cell */
  const numberOf = (cell) => {
    const number = typeof cell === "number" ? cell : NAMED.exec(cell)?.[2];
    return number === undefined ? null : Number(number);
  };

  widget("table", () => {
    /** @type {Row[]} */
    let rows = [];
    /** @type {string[]} */
    let columns = [];
    let sorted = -1;
    let isUp = true;
    const empty = el("div", { class: "wv-empty", role: "status" });
    const note = el("span", { class: "wv-quiet" });
    const head = el("div", { class: "wv-table-row", role: "row" });
    const host = el("div", { class: "wv-table" });
    const list = rowList({
      label: "Table",
      role: "grid",
      rowRole: "row",
      height: touchable(ROW_PX),
      make: () => el("div", { class: "wv-table-row" }),
      update(row, /** @type {Row} */ { cells }) {
        while (row.children.length > cells.length) row.lastElementChild?.remove();
        while (row.children.length < cells.length)
          row.append(el("span", { class: "wv-ellipsis wv-number", role: "gridcell" }));
        cells.forEach((cell, i) => setText(row.children[i], textOf(cell)));
      },
      host,
    });
    host.append(head, list.element);
    const save = iconButton("download", "Download as CSV", () => {
      download("table.csv", csvText([columns, ...rows.map(({ cells }) => cells)]));
    });

    /**
     * The letters that a column needs.
     *
     * @param {string} name
     * @param {number} column
     */
    function widthOf(name, column) {
      const texts = rows.slice(0, SAMPLE).map(({ cells }) => textOf(cells[column] ?? "").length);
      return Math.min(LETTERS[1], Math.max(LETTERS[0], name.length + 2, ...texts));
    }

    /** @param {number} column */
    function sort(column) {
      [sorted, isUp] = [column, sorted === column ? !isUp : true];
      draw();
    }

    /**
     * @param {number | string} a
     * @param {number | string} b
     */
    const compare = (a, b) => {
      const [x, y] = [numberOf(a), numberOf(b)];
      return x !== null && y !== null ? x - y : String(a).localeCompare(String(b));
    };

    function draw() {
      const order = isUp ? 1 : -1;
      list.show(
        sorted < 0
          ? rows
          : rows.toSorted((a, b) => order * compare(a.cells[sorted], b.cells[sorted])),
      );
      head.replaceChildren(
        ...columns.map((name, i) => {
          const state = i === sorted ? (isUp ? "ascending" : "descending") : null;
          const options = { type: "button", role: "columnheader", "aria-sort": state };
          return el("button", { ...options, class: "wv-ellipsis", onclick: () => sort(i) }, name);
        }),
      );
    }

    const element = el("div", { class: "wv-plugin-fill" }, empty, host);
    return {
      element,
      head: el("span", { class: "wv-panel-tools" }, note, save),
      update(values) {
        if (JSON.stringify(columns) !== JSON.stringify(values.columns ?? [])) sorted = -1;
        columns = values.columns ?? [];
        rows = (values.rows ?? []).map(
          (/** @type {Row["cells"]} */ cells, /** @type {number} */ i) => ({
            key: String(i),
            cells,
          }),
        );
        const widths = columns.map(widthOf);
        const least = widths.reduce((sum, width) => sum + width, 0);
        host.style.setProperty(
          "--wv-columns",
          widths.map((w) => `minmax(${w}ch, ${w}fr)`).join(" "),
        );
        host.style.setProperty("--wv-least", `calc(${least}ch + ${8 * columns.length}px)`);
        setText(note, [`${rows.length} rows`, values.note].filter(Boolean).join(", "));
        showText(empty, values.problem ?? "");
        draw();
      },
      close: list.close,
    };
  });
}
