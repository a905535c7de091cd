// A message as rows that fold, which arrow keys move through.

import { needs } from "../access.js";
import { indent, rowList, touchable } from "../controls/rows.js";
import { el, set, setText } from "../dom.js";
import { icon } from "../icons.js";
import { rowsOf } from "./message_tree.js";
import { plotField } from "./plot_field.js";

const ROW_PX = 22;

const NUMBER = /^-?(\d[\d.]*(e[+-]?\d+)?|inf)$|^nan$|^(True|False)$/;

/**
 * Returns `{element, show(tree), close()}`; a tree is that of `webviz.data.messages.to_tree`. Rows of
 * numbers have a button that plots them; `topic()` is the topic of the message.
 */
export function messageRows({ label, topic }) {
  const folds = new Map();
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
    const plot = el(
      "button",
      {
        type: "button",
        class: "wv-icon wv-field-plot",
        tabindex: -1,
        "aria-label": "Plot",
        "data-tip": "Plot this field",
        onclick: () => plotField(topic(), pathOf(plot.closest(".wv-row").wvKey)),
      },
      icon("odometry", 14),
    );
    return makeRow(needs("AddPanel", plot));
  }

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
    const isFold =
      (key === "ArrowLeft" && row.isOpen) || (key === "ArrowRight" && row.isOpen === false);
    if (isFold) toggle(row);
    else if (key === "ArrowLeft" && row.depth)
      list.mark(row.key.slice(0, row.key.lastIndexOf("/")));
    return isFold || key === "ArrowLeft";
  }

  return { element: list.element, show, close: list.close };
}

/** The path of a field by the key of its row: `/position/[0]` is `position[0]`. */
export const pathOf = (key) => key.slice(1).replaceAll("/[", "[").replaceAll("/", ".");

function makeRow(plot) {
  return el(
    "div",
    { class: "wv-field-row" },
    el("span", { class: "wv-fold-mark" }, icon("chevron", 12)),
    el("span", { class: "wv-field-name" }),
    el("span", { class: "wv-field-value wv-ellipsis" }),
    plot,
  );
}

function updateRow(element, row) {
  const [fold, name, value, plot] = element.children;
  set(plot, { hidden: !NUMBER.test(row.value) });
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
