// A message as rows that fold, which arrow keys move through.

import { needs } from "../access.js";
import { keyOf, rowList, touchable } from "../controls/rows.js";
import { el, set, setText } from "../dom.js";
import { iconButton } from "../icons.js";
import { foldByKey, foldMark, showFold } from "./folds.js";
import { rowsOf } from "./message_tree.js";
import { plotField } from "./plot_field.js";

/** @import {Fields, MessageRow} from "./message_tree.js" */

const ROW_PX = 22;

const NUMBER = /^-?(\d[\d.]*(e[+-]?\d+)?|inf)$|^nan$|^(True|False)$/;

/**
 * Returns `{element, show(tree), close()}`; a tree is that of `webviz.data.messages.to_tree`. Rows of
 * numbers have a button that plots them; `topic()` is the topic of the message.
 *
 * @param {{label: string, topic: () => string}} options
 */
export function messageRows({ label, topic }) {
  /** @type {Map<string, boolean>} */
  const folds = new Map();
  /** @type {Fields | null} */
  let shown = null;
  const list = rowList({
    label,
    role: "tree",
    rowRole: "treeitem",
    height: touchable(ROW_PX),
    make,
    update: updateRow,
    choose: toggle,
    onKey,
  });

  function make() {
    /** @type {HTMLButtonElement} */
    const plot = iconButton("odometry", "Plot", () => plotField(topic(), pathOf(keyOf(plot))), {
      class: "wv-icon wv-field-plot",
      tabindex: -1,
      tip: "Plot this field",
      size: 14,
    });
    return makeRow(needs("AddPanel", plot));
  }

  /** @param {Fields | null} tree */
  function show(tree) {
    shown = tree;
    list.show(tree ? rowsOf(tree, folds) : []);
  }

  /** @param {MessageRow} row */
  function toggle(row) {
    if (row.isOpen === null) return;
    folds.set(row.key, !row.isOpen);
    show(shown);
  }

  /**
   * @param {KeyboardEvent} event
   * @param {MessageRow} row
   * @returns {boolean}
   */
  function onKey({ key }, row) {
    return foldByKey(key, row, toggle, list);
  }

  return { element: list.element, show, close: list.close };
}

/**
 * The path of a field by the key of its row: `/position/[0]` is `position[0]`.
 *
 * @param {string} key
 */
export const pathOf = (key) => key.slice(1).replaceAll("/[", "[").replaceAll("/", ".");

/** @param {HTMLElement} plot */
function makeRow(plot) {
  return el(
    "div",
    { class: "wv-field-row" },
    foldMark(),
    el("span", { class: "wv-field-name" }),
    el("span", { class: "wv-field-value wv-ellipsis" }),
    plot,
  );
}

/**
 * @param {HTMLElement} element
 * @param {MessageRow} row
 */
function updateRow(element, row) {
  const [, name, value, plot] = element.children;
  set(plot, { hidden: !NUMBER.test(row.value) });
  setText(name, row.name);
  setText(value, row.value);
  set(value, { "data-tip": row.value.length > 30 ? row.value : null });
  showFold(element, row);
}
