// The widget "diagnostics": statuses as a tree, the worst first, and the values of one of them.

import { searchField } from "webviz/controls/fields.js";
import { indent, rowList, touchable } from "webviz/controls/rows.js";
import { el, svgElement } from "webviz/dom.js";
import { icon, iconButton } from "webviz/icons.js";
import { foldByKey } from "webviz/panels/folds.js";
import { computed, effect, signal } from "webviz/signals.js";
import { timeOfDay } from "webviz/time_text.js";

/** @import {Signal} from "../page/web/signals.js" */
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
const MAX_VALUES = 120; // values of a sparkline
const MAX_CURVES = 2000;
const LEVELS = ["ok", "warn", "error", "idle"];
const WORDS = ["OK", "Warning", "Error", "Stale"];
const RANKS = [0, 2, 3, 1];
const NUMBER = /^\s*-?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?/;

/** @param {Page} page */
export default function install({ widget }) {
  const curves = sparklines(); // while this page is open
  widget("diagnostics", () => diagnostics(curves));
}

/** @param {ReturnType<typeof sparklines>} curves */
function diagnostics(curves) {
  const statuses = signal(/** @type {Status[]} */ ([]));
  const problem = signal("");
  const part = signal("");
  const folds = signal(/** @type {Map<string, boolean>} */ (new Map()));
  const opened = signal(/** @type {string | null} */ (null));
  const matches = computed(() =>
    statuses.value.filter(({ path, message }) =>
      `${path.join("/")} ${message}`.toLowerCase().includes(part.value),
    ),
  );
  const chosen = computed(
    () => statuses.value.find(({ path }) => path.join("/") === opened.value) ?? null,
  );
  /** @type {HTMLInputElement} */
  const search = searchField(
    "Filter diagnostics",
    () => (part.value = search.value.toLowerCase()),
    { placeholder: "Filter" },
  );
  const list = tree(folds, (key) => (opened.value = key));
  effect(() => {
    const topics = new Set(matches.value.map(({ path }) => path[0]));
    const root = treeOf(matches.value, topics.size < 2 ? 1 : 0);
    list.show(rowsOf(root, folds.value, part.value !== ""));
  });
  const empty = { class: "wv-empty", role: "status", hidden: () => !problem.value };
  const detail = { class: "wv-plugin-detail wv-diagnostic-detail", hidden: () => !chosen.value };
  const close = () => (opened.value = null);
  return {
    element: el(
      "div",
      { class: "wv-plugin-fill" },
      el("div", empty, problem),
      list.element,
      el("div", detail, () => (chosen.value ? factsOf(chosen.value, curves, close) : [])),
    ),
    head: el(
      "span",
      { class: "wv-panel-tools" },
      el("span", { class: "wv-quiet" }, () => summaryOf(matches.value)),
      search,
    ),
    /**
     * @param {{parts: number, problem: string}} values
     * @param {(key: string) => {statuses: Status[]} | undefined} part
     */
    update(values, part) {
      const numbers = Array.from({ length: values.parts ?? 0 }, (_, i) => String(i));
      const now = numbers.flatMap((number) => part(number)?.statuses ?? []);
      curves.add(now);
      problem.value = values.problem ?? "";
      statuses.value = now;
    },
  };
}

/**
 * How many statuses have each level, the worst first.
 *
 * @param {Status[]} statuses
 */
const summaryOf = (statuses) =>
  [2, 1, 3, 0]
    .map((level) => ({ level, count: statuses.filter((each) => each.level === level).length }))
    .filter(({ count }) => count)
    .map(({ level, count }) => `${WORDS[level]} ${count}`)
    .join(" · ");

/**
 * The statuses as a tree, whose leaves are opened.
 *
 * @param {Signal<Map<string, boolean>>} folds
 * @param {(key: string) => unknown} open
 */
function tree(folds, open) {
  /** @param {Row} row */
  const toggle = ({ key, isOpen }) => {
    if (isOpen !== null) folds.value = new Map(folds.value).set(key, !isOpen);
  };
  /** @type {ReturnType<typeof rowList<Row>>} */
  const list = rowList({
    label: "Diagnostics",
    role: "tree",
    rowRole: "treeitem",
    height: touchable(ROW_PX),
    row: rowOf,
    choose: (row) => (row.isOpen === null ? open(row.key) : toggle(row)),
    onKey: ({ key }, row) => foldByKey(key, row, toggle, list),
  });
  return list;
}

/** @param {() => Row} row */
function rowOf(row) {
  const isOpen = () => row().isOpen;
  const element = el(
    "div",
    {
      class: "wv-diagnostic",
      "data-level": () => LEVELS[row().level],
      "aria-level": () => row().depth + 1,
      "aria-expanded": () => (isOpen() === null ? null : String(isOpen())),
    },
    el(
      "span",
      {
        class: "wv-fold-mark",
        "data-open": () => Boolean(isOpen()),
        "data-none": () => isOpen() === null,
      },
      icon("chevron", 12),
    ),
    el("span"),
    el("span", { class: "wv-ellipsis" }, () => row().name),
    el("span", { class: "wv-ellipsis", "data-tip": () => row().text || null }, () => row().text),
  );
  effect(() => indent(element, row().depth));
  return element;
}

/**
 * All that is known of a status.
 *
 * @param {Status} status
 * @param {ReturnType<typeof sparklines>} curves
 * @param {() => void} close
 */
function factsOf({ path, level, message, hardware, values, at }, curves, close) {
  const rows = values.map(([name, text]) =>
    el(
      "tr",
      {},
      el("td", { class: "wv-quiet" }, name),
      el("td", {}, text),
      el("td", {}, curves.draw([...path, name].join("\n"))),
    ),
  );
  const name = path.slice(1).join(" / ");
  const facts = [WORDS[level], hardware, timeOfDay(at)].filter(Boolean);
  return [
    el(
      "div",
      { class: "wv-plugin-bar" },
      el("b", { class: "wv-ellipsis" }, name),
      iconButton("close", "Close", close),
    ),
    el("div", {}, message || "No message."),
    el("div", { class: "wv-quiet" }, facts.join(" · ")),
    el("table", {}, el("tbody", {}, rows)),
  ];
}

/** The latest numbers of statuses: `{add(statuses), draw(name)}`, by path and key, one a line. */
function sparklines() {
  /** @type {Map<string, {at: number, values: number[]}>} */
  const history = new Map();

  /**
   * @param {string} name
   * @param {number} at
   * @param {number} number
   */
  function note(name, at, number) {
    const curve = history.get(name);
    if (!curve) {
      if (history.size < MAX_CURVES) history.set(name, { at, values: [number] });
    } else if (curve.at !== at) {
      if (at < curve.at) curve.values = [];
      curve.at = at;
      curve.values.push(number);
      if (curve.values.length > MAX_VALUES) curve.values.shift();
    }
  }

  return {
    /** @param {Status[]} statuses */
    add(statuses) {
      for (const { path, values, at } of statuses) {
        for (const [key, text] of values) {
          const number = NUMBER.test(text) ? Number.parseFloat(text) : NaN;
          if (Number.isFinite(number)) note([...path, key].join("\n"), at, number);
        }
      }
    },
    /** @param {string} name */
    draw(name) {
      const values = history.get(name)?.values ?? [];
      return values.length < 2 ? null : sparkline(values);
    },
  };
}

/** @param {number[]} values */
function sparkline(values) {
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
