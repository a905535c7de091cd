// A message as rows that fold, which arrow keys move through.

import { indent, rowList, touchable } from "../controls/rows.js";
import { el, set, setText } from "../dom.js";
import { icon } from "../icons.js";
import { rowsOf } from "./message_tree.js";

const ROW_PX = 22;

/** Returns `{element, show(tree), close()}`; a tree is that of `webviz.data.messages.to_tree`. */
export function messageRows({ label }) {
  const folds = new Map();
  let shown = null;
  const list = rowList({
    label, role: "tree", rowRole: "treeitem", height: touchable(ROW_PX),
    make: makeRow, update: updateRow, choose: toggle, onKey,
  });

  function show(tree) {
    shown = tree;
    list.show(tree ? rowsOf(tree, folds) : []);
  }

  function toggle(row) {
    if (row.isOpen === null) return;
    folds.set(row.key, !row.isOpen);
    show(shown);
  }

  function onKey({ key }, row) {
    const isFold = (key === "ArrowLeft" && row.isOpen) || (key === "ArrowRight" && row.isOpen === false);
    if (isFold) toggle(row);
    else if (key === "ArrowLeft" && row.depth) list.mark(row.key.slice(0, row.key.lastIndexOf("/")));
    return isFold || key === "ArrowLeft";
  }

  return { element: list.element, show, close: list.close };
}

function makeRow() {
  return el("div", { class: "wv-field-row" },
    el("span", { class: "wv-fold-mark" }, icon("chevron", 12)),
    el("span", { class: "wv-field-name" }), el("span", { class: "wv-field-value wv-ellipsis" }));
}

function updateRow(element, row) {
  const [fold, name, value] = element.children;
  set(fold, { "data-open": row.isOpen ? "" : null, "data-none": row.isOpen === null ? "" : null });
  setText(name, row.name);
  setText(value, row.value);
  set(value, { "data-tip": row.value.length > 30 ? row.value : null });
  set(element, {
    "aria-level": row.depth + 1,
    "aria-expanded": row.isOpen === null ? null : String(row.isOpen),
  });
  indent(element, row.depth);
}
