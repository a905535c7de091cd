// The panel "Selection": what this page has selected in the scene, as a tree of values.

import { copyAndTell } from "../clipboard.js";
import { rowList, touchable } from "../controls/rows.js";
import { el, set, setText, showText } from "../dom.js";
import { icon, iconButton, textButton } from "../icons.js";
import { openPanel } from "../docks/layout.js";
import { watch } from "../stores.js";
import { select } from "../tools/registry.js";
import * as tool from "../tools/select.js";
import * as selection from "../tools/selection.js";
import { foldByKey, foldMark, showFold } from "./folds.js";
import { rowsOf, textOf } from "./message_tree.js";
import { statisticsRows, statisticsText } from "./statistics.js";
import { showFrame } from "./frame_actions.js";

/** @import {Panel, ValuesOf} from "../types.js" */
/** @import {Fields, MessageRow} from "./message_tree.js" */

/**
 * A row of a thing, of one of its values, or of statistics.
 *
 * @typedef {MessageRow & {isThing?: boolean, isStatistics?: boolean, remark?: string}} SelectionRow
 */

const ROW_PX = 24;
const FRAMES = new Set(["Frame", "Parent", "Parent frame", "Child frame", "Reference frame"]);

/** @type {Panel} */
export const selectionPanel = {
  name: "selection",
  title: "Selection",
  order: 10,
  open(element) {
    /** @type {Map<string, boolean>} */
    const folds = new Map();
    /** @type {ValuesOf<"selection">} */
    let values = new Map();
    /** @type {Set<string>} */
    let frames = new Set();

    const count = el("span", { class: "wv-selection-count", role: "status" });
    const look = iconButton("focus", "Look at the selection", tool.lookAtSelection);
    const copyAll = iconButton("copy", "Copy all values", () => copyAndTell(textOfAll(values)));
    const clear = iconButton("close", "Clear the selection", () => selection.change("replace", []));
    const note = el("div", { class: "wv-selection-note wv-quiet", hidden: true });
    const list = rowList({
      label: "Selection",
      role: "tree",
      rowRole: "treeitem",
      height: touchable(ROW_PX),
      make: makeRow,
      update: updateRow,
      choose,
      onKey,
    });
    const start = textButton("Select", () => select(tool.select), { icon: "select" });
    const empty = el(
      "div",
      { class: "wv-empty" },
      el("p", {}, "Nothing is selected. Choose the tool, and click on something in the scene."),
      start,
    );
    element.append(
      el(
        "section",
        { class: "wv-selection", "aria-label": "Selection" },
        el("header", {}, count, look, copyAll, clear),
        note,
        empty,
        list.element,
      ),
    );
    list.element.addEventListener("click", onLink, { capture: true });

    function show() {
      const ids = idsOf(values);
      const { total = 0, count: held = 0, live = 0, displays = [] } = values.get("/info") ?? {};
      list.show([
        ...statisticsRows(displays, folds),
        ...ids.flatMap((id) => rowsOfThing(id, ids.length === 1)),
      ]);
      setText(count, held ? `${held} selected` : "");
      set(empty, { hidden: held > 0 });
      for (const one of [look, copyAll, clear]) set(one, { disabled: held === 0 });
      const notes = [
        held < total ? `The first ${held} of ${total}.` : "",
        held > live ? "Too many items to update live: these are the values at selection." : "",
      ];
      showText(note, notes.filter(Boolean).join(" "));
    }

    /**
     * @param {string} id
     * @param {boolean} isAlone
     * @returns {SelectionRow[]}
     */
    function rowsOfThing(id, isAlone) {
      const thing = values.get(id);
      if (!thing) return [];
      const { title, name, tree, note: remark } = thing;
      const isOpen = folds.get(id) ?? isAlone;
      const row = {
        key: id,
        depth: 0,
        name: title,
        value: name,
        isOpen,
        isThing: true,
        remark,
      };
      return isOpen ? [row, ...rowsOf(/** @type {Fields} */ (tree), folds, 1, id)] : [row];
    }

    /**
     * @param {SelectionRow} row
     * @returns {unknown}
     */
    function choose(row) {
      if (row.isOpen === null) return copyAndTell(row.value);
      folds.set(row.key, !row.isOpen);
      show();
    }

    /**
     * @param {KeyboardEvent} event
     * @param {SelectionRow} row
     * @returns {boolean}
     */
    function onKey({ key }, row) {
      return foldByKey(key, row, choose, list);
    }

    function makeRow() {
      return el(
        "div",
        { class: "wv-field-row" },
        foldMark(),
        el("span", { class: "wv-field-name" }),
        el("span", { class: "wv-field-value wv-ellipsis" }),
        el(
          "button",
          {
            type: "button",
            class: "wv-icon wv-selection-frame",
            title: "Show the frame in the panel TF",
            "aria-label": "Show the frame",
            tabindex: -1,
          },
          icon("tree", 14),
        ),
      );
    }

    /**
     * @param {HTMLElement} row
     * @param {SelectionRow} shown
     */
    function updateRow(
      row,
      { name, value, depth, isOpen, isThing = false, isStatistics = false, remark = "" },
    ) {
      const [, label, text, link] = row.children;
      setText(label, name);
      setText(text, isThing && remark ? `${value} · replaced` : value);
      set(row, {
        "data-thing": isThing,
        "data-statistics": isStatistics,
        "data-tip": remark || (isOpen === null ? `${value}\nClick to copy` : null),
      });
      const frame = FRAMES.has(name) && frames.has(value) ? value : null;
      set(link, { hidden: frame === null, "data-frame": frame });
      showFold(row, { depth, isOpen });
    }

    /** @param {MouseEvent} event */
    function onLink(event) {
      const link = /** @type {Element} */ (event.target).closest(".wv-selection-frame");
      const frame = link?.getAttribute("data-frame");
      if (typeof frame !== "string") return;
      event.stopPropagation();
      showFrame(frame);
      openPanel("transforms");
    }

    const ends = [
      watch(`selection:${window.webviz.browser}`, (known) => {
        values = known;
        show();
      }),
      watch("frames", (known) => {
        frames = new Set(known.get("frames") ?? []);
        show();
      }),
    ];
    show();
    return () => {
      for (const end of ends) end();
      list.close();
      element.replaceChildren();
    };
  },
};

/**
 * Ids of what is selected, in the order in which it was.
 *
 * @param {ValuesOf<"selection">} values
 */
const idsOf = (values) =>
  [...values.keys()].filter((id) => id !== "/info").sort((a, b) => Number(a) - Number(b));

/** @param {ValuesOf<"selection">} values */
const textOfAll = (values) =>
  statisticsText(values.get("/info")?.displays ?? []) +
  idsOf(values)
    .map((id) => {
      const thing = values.get(id);
      if (!thing) return "";
      const head = [`${thing.title} (${thing.name})`, thing.note].filter(Boolean).join(": ");
      return `${head}\n${textOf(/** @type {Fields} */ (thing.tree), "  ")}\n`;
    })
    .join("");
