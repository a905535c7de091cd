// A message as rows that fold, which arrow keys move through.

import { needs } from "webviz/access.js";
import { rowList, touchable } from "webviz/controls/rows.js";
import { el } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { effect } from "webviz/signals.js";
import { dragField } from "webviz/panels/field_drag.js";
import { foldByKey, foldMark, showFold } from "webviz/panels/folds.js";
import { NAMED, rowsOf } from "webviz/panels/message_tree.js";
import { plotField } from "webviz/panels/plot_field.js";

/** @import {Fields, MessageRow} from "webviz/panels/message_tree.js" */

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
  let current = null;

  /** @param {Fields | null} tree */
  function show(tree) {
    current = tree;
    list.show(tree ? rowsOf(tree, folds) : []);
  }

  /** @param {MessageRow} row */
  function toggle(row) {
    if (row.isOpen === null) return;
    folds.set(row.key, !row.isOpen);
    show(current);
  }

  /** @type {ReturnType<typeof rowList<MessageRow>>} */
  const list = rowList({
    label,
    role: "tree",
    rowRole: "treeitem",
    height: touchable(ROW_PX),
    row: (row) => messageRow(row, topic),
    choose: toggle,
    onKey: ({ key }, row) => foldByKey(key, row, toggle, list),
  });
  return { element: list.element, show, close: list.close };
}

/**
 * The path of a field by the key of its row: `/position/[0]` is `position[0]`.
 *
 * @param {string} key
 */
const pathOf = (key) => key.slice(1).replaceAll("/[", "[").replaceAll("/", ".");

/**
 * @param {() => MessageRow} row
 * @param {() => string} topic
 */
function messageRow(row, topic) {
  const value = () => row().value;
  const plot = iconButton("odometry", "Plot", () => plotField(topic(), pathOf(row().key)), {
    class: "wv-icon wv-field-plot",
    tabindex: -1,
    tip: "Plot this field",
    size: 14,
    hidden: () => !NUMBER.test(value()) && !NAMED.test(value()),
  });
  const tip = () => (value().length > 30 ? value() : null);
  const element = el(
    "div",
    { class: "wv-field-row" },
    foldMark(),
    el("span", { class: "wv-field-name" }, () => row().name),
    el("span", { class: "wv-field-value wv-ellipsis", "data-tip": tip }, value),
    needs("AddPanel", plot),
  );
  effect(() => showFold(element, row()));
  dragField(element, () => ({ topic: topic(), path: pathOf(row().key) }));
  return element;
}
