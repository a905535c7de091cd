// The widget "diagnostics": statuses as a tree, the worst first, and the values of one of them.

import { searchField } from "webviz/controls/fields.js";
import { indent, rowList, touchable } from "webviz/controls/rows.js";
import { el, set, setText, showText, svgElement } from "webviz/dom.js";
import { icon, iconButton } from "webviz/icons.js";
import { foldByKey } from "webviz/panels/folds.js";
import { timeOfDay } from "webviz/time_text.js";

/** @import {Page} from "../page/web/extensions.js" */

/**
 * @typedef {{
 *   path: string[], level: number, message: string, hardware: string, values: [string, string][], at: number,
 * }} Status
 * @typedef {{name: string, key: string, level: number, inner: Map<string, Node>, status: Status | null}} Node
 * @typedef {{
 *   key: string, depth: number, name: string, level: number, text: string, isOpen: boolean | null,
 *   status: Status | null,
 * }} Row
 */

const ROW_PX = 24;
const KEPT = 120; // values of a sparkline
const MAX_CURVES = 2000;
const LEVELS = ["ok", "warn", "error", "idle"];
const WORDS = ["OK", "Warning", "Error", "Stale"];
const RANKS = [0, 2, 3, 1];
const NUMBER = /^\s*-?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?/;

/** @param {Page} page */
export default function install({ widget }) {
  /** @type {Map<string, {at: number, values: number[]}>} */
  const history = new Map(); // by status and value, while this page is open

  /** @param {Status[]} statuses */
  function remember(statuses) {
    for (const { path, values, at } of statuses) {
      for (const [key, text] of values) {
        const number = NUMBER.test(text) ? Number.parseFloat(text) : NaN;
        if (!Number.isFinite(number)) continue;
        const name = [...path, key].join("\n");
        const known = history.get(name);
        if (!known) {
          if (history.size < MAX_CURVES) history.set(name, { at, values: [number] });
        } else if (known.at !== at) {
          if (at < known.at) known.values = [];
          known.at = at;
          known.values.push(number);
          if (known.values.length > KEPT) known.values.shift();
        }
      }
    }
  }

  /** @param {string} name */
  function sparkline(name) {
    const values = history.get(name)?.values ?? [];
    if (values.length < 2) return null;
    const low = Math.min(...values);
    const size = Math.max(...values) / 2 - low / 2; // the difference of large values overflows
    const points = values.map((value, i) => {
      const y = size > 0 ? (value / 2 - low / 2) / size : 0.5;
      return `${((i * 88) / (values.length - 1) + 1).toFixed(1)},${(16 - 14 * y).toFixed(1)}`;
    });
    const line = svgElement("polyline", { points: points.join(" ") });
    const label = `${values.length} values`;
    return svgElement("svg", { viewBox: "0 0 90 18", role: "img", "aria-label": label }, line);
  }

  widget("diagnostics", () => {
    /** @type {Status[]} */
    let statuses = [];
    /** @type {Map<string, boolean>} */
    const folds = new Map();
    /** @type {string | null} */
    let opened = null;
    const empty = el("div", { class: "wv-empty", role: "status" });
    const summary = el("span", { class: "wv-quiet" });
    const search = searchField("Filter diagnostics", draw, { placeholder: "Filter" });
    const detail = el("div", { class: "wv-plugin-detail wv-diagnostic-detail", hidden: true });
    const list = rowList({
      label: "Diagnostics",
      role: "tree",
      rowRole: "treeitem",
      height: touchable(ROW_PX),
      make: () =>
        el(
          "div",
          { class: "wv-diagnostic" },
          el("span", { class: "wv-fold-mark" }, icon("chevron", 12)),
          el("span"),
          el("span", { class: "wv-ellipsis" }),
          el("span", { class: "wv-ellipsis" }),
        ),
      update(element, /** @type {Row} */ row) {
        const [fold, , name, text] = element.children;
        const { isOpen } = row;
        set(fold, { "data-open": isOpen ? "" : null, "data-none": isOpen === null ? "" : null });
        setText(name, row.name);
        setText(text, row.text);
        set(text, { "data-tip": row.text || null });
        set(element, {
          "data-level": LEVELS[row.level],
          "aria-level": row.depth + 1,
          "aria-expanded": isOpen === null ? null : String(isOpen),
        });
        indent(element, row.depth);
      },
      choose(row) {
        if (row.isOpen === null) show(row.key);
        else toggle(row);
      },
      onKey,
    });

    /**
     * @param {KeyboardEvent} event
     * @param {Row} row
     * @returns {boolean}
     */
    function onKey({ key }, row) {
      return foldByKey(key, row, toggle, list);
    }

    /** @param {Row} row */
    function toggle(row) {
      if (row.isOpen === null) return;
      folds.set(row.key, !row.isOpen);
      draw();
    }

    /** @param {string | null} key */
    function show(key) {
      opened = key;
      const status = statuses.find(({ path }) => path.join("/") === key);
      set(detail, { hidden: !status });
      if (!status) return;
      const rows = status.values.map(([name, text]) =>
        el(
          "tr",
          {},
          el("td", { class: "wv-quiet" }, name),
          el("td", {}, text),
          el("td", {}, sparkline([...status.path, name].join("\n"))),
        ),
      );
      const name = status.path.slice(1).join(" / ");
      const facts = [WORDS[status.level], status.hardware, timeOfDay(status.at)].filter(Boolean);
      detail.replaceChildren(
        el(
          "div",
          { class: "wv-plugin-bar" },
          el("b", { class: "wv-ellipsis" }, name),
          iconButton("close", "Close", () => show(null)),
        ),
        el("div", {}, status.message || "Without a message."),
        el("div", { class: "wv-quiet" }, facts.join(" · ")),
        el("table", {}, el("tbody", {}, rows)),
      );
    }

    function draw() {
      const part = search.value.toLowerCase();
      const found = statuses.filter(
        ({ path, message }) => !part || `${path.join("/")} ${message}`.toLowerCase().includes(part),
      );
      const topics = new Set(found.map(({ path }) => path[0]));
      const root = treeOf(found, topics.size < 2 ? 1 : 0);
      list.show(rowsOf(root, folds, part !== ""));
      const counts = WORDS.map((word, level) => [
        word,
        found.filter((each) => each.level === level).length,
      ]);
      const texts = [2, 1, 3, 0].filter((i) => counts[i][1]).map((i) => counts[i].join(" "));
      setText(summary, texts.join(" · "));
      show(opened);
    }

    /**
     * @param {{parts: number, problem: string}} values
     * @param {(key: string) => {statuses: Status[]} | undefined} part
     */
    function update({ parts = 0, problem = "" }, part) {
      statuses = Array.from({ length: parts }, (_, i) => part(String(i))?.statuses ?? []).flat();
      remember(statuses);
      showText(empty, problem);
      draw();
    }

    const head = el("span", { class: "wv-panel-tools" }, summary, search);
    const element = el("div", { class: "wv-plugin-fill" }, empty, list.element, detail);
    return { element, head, update, close: list.close };
  });
}

/**
 * @param {Status[]} statuses
 * @param {number} from the first name of their paths that counts
 */
function treeOf(statuses, from) {
  /** @type {Node} */
  const root = { name: "", key: "", level: 0, inner: new Map(), status: null };
  for (const status of statuses) {
    let node = root;
    let key = status.path.slice(0, from).join("/");
    for (const name of status.path.slice(from)) {
      key = key ? `${key}/${name}` : name;
      const next = node.inner.get(name) ?? { name, key, level: 0, inner: new Map(), status: null };
      if (RANKS[status.level] > RANKS[next.level]) next.level = status.level;
      node.inner.set(name, next);
      node = next;
    }
    node.status = status;
  }
  return root;
}

/**
 * The rows of what is not folded away; what is not OK is unfolded at first.
 *
 * @param {Node} node
 * @param {Map<string, boolean>} folds
 * @param {boolean} isFiltered
 * @param {number} [depth]
 * @returns {Row[]}
 */
function rowsOf(node, folds, isFiltered, depth = 0) {
  const inner = [...node.inner.values()].toSorted(
    (a, b) => RANKS[b.level] - RANKS[a.level] || a.name.localeCompare(b.name),
  );
  return inner.flatMap((each) => {
    const { name, key, level, status } = each;
    const isLeaf = !each.inner.size;
    const isOpen = isLeaf ? null : (folds.get(key) ?? (isFiltered || level === 1 || level === 2));
    const row = { key, depth, name, level, text: status?.message ?? "", isOpen, status };
    return isOpen ? [row, ...rowsOf(each, folds, isFiltered, depth + 1)] : [row];
  });
}
