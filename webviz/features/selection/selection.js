// The panel "Selection": what this page has selected in the scene, as a tree of values.

import { copyAndTell } from "webviz/clipboard.js";
import { rowList, touchable } from "webviz/controls/rows.js";
import { el } from "webviz/dom.js";
import { iconButton, textButton } from "webviz/icons.js";
import { openPanel } from "webviz/docks/layout.js";
import { ownStore } from "webviz/own_store.js";
import { computed, effect, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { select } from "webviz/tools/registry.js";
import * as tool from "webviz/features/selection/select.js";
import * as selection from "webviz/tools/selection.js";
import { panel } from "webviz/panels/panels.js";
import { foldByKey, foldMark, showFold } from "webviz/panels/folds.js";
import { rowsOf, textOf } from "webviz/panels/message_tree.js";
import { statisticsRows, statisticsText } from "webviz/features/selection/statistics.js";
import { showFrame } from "webviz/panels/frame_actions.js";

/** @import {Panel} from "webviz/types.js" */
/** @import {Fields, MessageRow} from "webviz/panels/message_tree.js" */

/**
 * A row of a thing, of one of its values, or of statistics.
 *
 * @typedef {MessageRow & {isThing?: boolean, isStatistics?: boolean, remark?: string}} SelectionRow
 */

const ROW_PX = 24;
const NOTHING = "Nothing is selected. Choose the tool, and click on something in the scene.";
const FRAMES = new Set(["Frame", "Parent", "Parent frame", "Child frame", "Reference frame"]);

const values = ownStore("selection");
const frames = store("frames");

export function install() {
  selection.install(ownStore("selected"));
  tool.install();
  panel(selectionPanel);
}

/** @type {Panel} */
const selectionPanel = {
  name: "selection",
  title: "Selection",
  order: 10,
  open(element) {
    const folds = signal(/** @type {Map<string, boolean>} */ (new Map()));
    const count = () => values.get("/info")?.count ?? 0;
    /**
     * @param {string} name
     * @param {string} label
     * @param {() => unknown} run
     */
    const button = (name, label, run) =>
      iconButton(name, label, run, { disabled: () => count() === 0 });
    /** @param {SelectionRow} row */
    const choose = ({ key, isOpen, value }) => {
      if (isOpen === null) copyAndTell(value);
      else folds.value = new Map(folds.value).set(key, !isOpen);
    };
    /** @type {ReturnType<typeof rowList<SelectionRow>>} */
    const list = rowList({
      label: "Selection",
      role: "tree",
      rowRole: "treeitem",
      height: touchable(ROW_PX),
      row: rowOf,
      choose,
      onKey: ({ key }, row) => foldByKey(key, row, choose, list),
    });
    effect(() => list.show(rowsIn(folds.value)));
    const start = textButton("Select", () => select(tool.select), { icon: "select" });
    element.append(
      el(
        "section",
        { class: "wv-selection", "aria-label": "Selection" },
        el(
          "header",
          {},
          el("span", { class: "wv-selection-count", role: "status" }, () =>
            count() ? `${count()} selected` : "",
          ),
          button("focus", "Look at the selection", tool.lookAtSelection),
          button("copy", "Copy all values", () => copyAndTell(textOfAll())),
          button("close", "Clear the selection", () => selection.change("replace", [])),
        ),
        el("div", { class: "wv-selection-note wv-quiet", hidden: () => !note() }, note),
        el("div", { class: "wv-empty", hidden: () => count() > 0 }, el("p", {}, NOTHING), start),
        list.element,
      ),
    );
    return () => element.replaceChildren();
  },
};

/** @param {string} name */
function openFrame(name) {
  showFrame(name);
  openPanel("transforms");
}

/** A sentence on values that the rows lack, "" without any. */
function note() {
  const { total = 0, count = 0, live = 0 } = values.get("/info") ?? {};
  const notes = [
    count < total ? `The first ${count} of ${total}.` : "",
    count > live ? "Too many items to update live: these are the values at selection." : "",
  ];
  return notes.filter(Boolean).join(" ");
}

/**
 * @param {Map<string, boolean>} folds
 * @returns {SelectionRow[]}
 */
function rowsIn(folds) {
  const ids = idsOf();
  return [
    ...statisticsRows(values.get("/info")?.displays ?? [], folds),
    ...ids.flatMap((id) => rowsOfThing(id, folds, ids.length === 1)),
  ];
}

/**
 * @param {string} id
 * @param {Map<string, boolean>} folds
 * @param {boolean} isAlone
 * @returns {SelectionRow[]}
 */
function rowsOfThing(id, folds, isAlone) {
  const thing = values.get(id);
  if (!thing) return [];
  const { title, name, tree, note: remark } = thing;
  const isOpen = folds.get(id) ?? isAlone;
  const row = { key: id, depth: 0, name: title, value: name, isOpen, isThing: true, remark };
  return isOpen ? [row, ...rowsOf(/** @type {Fields} */ (tree), folds, 1, id)] : [row];
}

/** @param {() => SelectionRow} row */
function rowOf(row) {
  const frame = computed(() => {
    const { name, value } = row();
    return FRAMES.has(name) && frames.get("frames")?.includes(value) ? value : null;
  });
  const element = el(
    "div",
    {
      class: "wv-field-row",
      "data-thing": () => row().isThing ?? false,
      "data-statistics": () => row().isStatistics ?? false,
      "data-tip": () =>
        row().remark || (row().isOpen === null ? `${row().value}\nClick to copy` : null),
    },
    foldMark(),
    el("span", { class: "wv-field-name" }, () => row().name),
    el("span", { class: "wv-field-value wv-ellipsis" }, () =>
      row().isThing && row().remark ? `${row().value} · replaced` : row().value,
    ),
    iconButton("tree", "Show the frame", () => openFrame(frame.value ?? ""), {
      class: "wv-icon wv-selection-frame",
      title: "Show the frame in the panel TF",
      tip: null,
      tabindex: -1,
      size: 14,
      hidden: () => frame.value === null,
      "data-frame": frame,
    }),
  );
  effect(() => showFold(element, row()));
  return element;
}

/** Ids of what is selected, in the order in which it was. */
const idsOf = () =>
  [...(values.all()?.keys() ?? [])]
    .filter((id) => id !== "/info")
    .sort((a, b) => Number(a) - Number(b));

const textOfAll = () =>
  statisticsText(values.get("/info")?.displays ?? []) +
  idsOf()
    .map((id) => {
      const thing = values.get(id);
      if (!thing) return "";
      const head = [`${thing.title} (${thing.name})`, thing.note].filter(Boolean).join(": ");
      return `${head}\n${textOf(/** @type {Fields} */ (thing.tree), "  ")}\n`;
    })
    .join("");
