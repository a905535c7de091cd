// The keys of the tree, as the pattern for trees of ARIA has them, and those that move displays.

import { shortcuts, takeKeysOf } from "webviz/keys.js";
import * as actions from "webviz/panels/displays/actions.js";
import { isOpen, setOpen } from "webviz/panels/displays/folding.js";
import { topmost } from "webviz/panels/displays/model.js";
import * as selection from "webviz/panels/displays/selection.js";

/** @import {Item, Tree, Way} from "webviz/panels/displays/types.js" */

const ROW_PX = 26;

/**
 * A key by itself, and with those that extend the selection or keep it.
 *
 * @param {string} key
 */
const extending = (key) => ["", "Shift+", "Ctrl+", "Ctrl+Shift+"].map((before) => before + key);

/**
 * Does something to the row that keys act on, if there is one.
 *
 * @param {(tree: Tree, item: Item, event: KeyboardEvent) => unknown} act
 */
const onRow = (act) => (/** @type {Tree} */ tree, /** @type {KeyboardEvent} */ event) => {
  const item = tree.rows()[here(tree)];
  return item ? act(tree, item, event) : false;
};

/**
 * Goes to the row that `index(here, page)` names, where a page is as many rows as are seen.
 *
 * @param {(here: number, page: number) => number} index
 */
const going = (index) => (/** @type {Tree} */ tree, /** @type {KeyboardEvent} */ event) =>
  go(
    tree,
    index(here(tree), Math.max(1, Math.floor(tree.element.clientHeight / ROW_PX) - 1)),
    event,
  );

/** @param {Way} way */
const moving = (way) => (/** @type {Tree} */ tree) =>
  actions.moveBy(tree.model(), selection.ids(), way);

/** @param {Tree} tree */
const here = (tree) => tree.rows().findIndex(({ id }) => id === selection.active());
/** @param {Tree} tree */
const chosen = (tree) => topmost(tree.model(), selection.ids());

/** @type {ReturnType<typeof shortcuts<Tree>>} */
const take = shortcuts("Tree of displays", [
  { does: "Show or hide displays", keys: [" "], unnamed: ["Ctrl+ "], run: onRow(switchOn) },
  { does: "Copy as YAML", keys: ["Ctrl+c"], run: copy },
  { does: "Select all", keys: ["Ctrl+a"], run: selectAll },
  {
    does: "Unfold, fold",
    keys: ["ArrowRight", "ArrowLeft"],
    unnamed: [...extending("ArrowRight"), ...extending("ArrowLeft")],
    run: onRow(fold),
  },
  {
    does: "Properties in the tree",
    keys: ["Enter"],
    run: onRow((tree, item) => tree.setOpen(item, !isOpen(item))),
  },
  { does: "Move in the list", keys: ["Alt+ArrowUp"], run: moving("up") },
  { does: "Move in the list", keys: ["Alt+ArrowDown"], run: moving("down") },
  { does: "Into and out of a group", keys: ["Alt+ArrowRight"], run: moving("into") },
  { does: "Into and out of a group", keys: ["Alt+ArrowLeft"], run: moving("out") },
  {
    does: "Actions",
    keys: ["Shift+F10"],
    unnamed: ["ContextMenu"],
    run: onRow((tree, { id }) => tree.openMenu(id)),
  },
  { does: "", keys: [], unnamed: extending("ArrowDown"), run: going((at) => at + 1) },
  { does: "", keys: [], unnamed: extending("ArrowUp"), run: going((at) => at - 1) },
  { does: "", keys: [], unnamed: extending("PageDown"), run: going((at, page) => at + page) },
  { does: "", keys: [], unnamed: extending("PageUp"), run: going((at, page) => at - page) },
  { does: "", keys: [], unnamed: extending("Home"), run: going(() => 0) },
  { does: "", keys: [], unnamed: extending("End"), run: going(() => Infinity) },
]);

/**
 * Answers to keys in a tree; letters are for tools, wherever the focus is.
 *
 * @param {HTMLElement} element
 * @param {Tree} tree
 */
export const listenToKeys = (element, tree) =>
  takeKeysOf(element, (event) => {
    const target = /** @type {Element} */ (event.target);
    return target.getAttribute("role") === "treeitem" && take(tree, event);
  });

/**
 * @param {Tree} tree
 * @param {number} index
 * @param {KeyboardEvent} event
 */
function go(tree, index, event) {
  const rows = tree.rows();
  const row = rows[Math.max(0, Math.min(index, rows.length - 1))];
  if (!row) return;
  if (event.shiftKey) selection.extend(row.id, rows);
  else if (event.ctrlKey || event.metaKey) selection.activate(row.id);
  else selection.choose(row.id);
  tree.showActive();
}

/**
 * @param {Tree} tree
 * @param {Item} item
 * @param {KeyboardEvent} event
 */
function fold(tree, item, event) {
  if (event.key === "ArrowRight") {
    if (!isOpen(item)) setOpen(item, true);
    else if (item.children.length) return go(tree, here(tree) + 1, event);
  } else if (isOpen(item)) setOpen(item, false);
  else if (item.parent) return go(tree, tree.rows().indexOf(item.parent), event);
  tree.refresh();
}

/**
 * @param {Tree} tree
 * @param {Item} item
 * @param {KeyboardEvent} event
 */
function switchOn(tree, item, event) {
  if (event.ctrlKey || event.metaKey) {
    selection.toggle(item.id);
    tree.refresh();
    return;
  }
  const isOne = !selection.isSelected(item.id);
  const items = (
    isOne ? [item] : [...selection.ids()].flatMap((id) => tree.model().byId.get(id) ?? [])
  ).filter((each) => each.can_edit);
  if (items.length) actions.setEnabled(items, !actions.isEnabled(item), () => tree.refresh());
}

/** @param {Tree} tree */
function selectAll(tree) {
  for (const { id } of tree.model().items) selection.ids().add(id);
  tree.refresh();
}

/** @param {Tree} tree */
function copy(tree) {
  const displays = chosen(tree);
  if (!displays.length) return false;
  actions.copyAsYaml(displays);
}
