// The keys of the tree, as the pattern for trees of ARIA has them, and those that move displays.

import * as actions from "./actions.js";
import { isOpen, setOpen } from "./folding.js";
import { topmost } from "./model.js";
import * as selection from "./selection.js";

/** @import {Item, Tree, Way} from "./types.js" */

/** @type {Record<string, Way>} */
const WAYS = { ArrowUp: "up", ArrowDown: "down", ArrowLeft: "out", ArrowRight: "into" };

/**
 * Answers to keys in a tree; see `tree.js` for what is asked of that.
 *
 * @param {HTMLElement} element
 * @param {Tree} tree
 */
export function listenToKeys(element, tree) {
  const rows = () => tree.rows();
  const here = () => rows().findIndex(({ id }) => id === selection.active());
  const chosen = () => topmost(tree.model(), selection.ids());

  /**
   * @param {number} index
   * @param {KeyboardEvent} event
   */
  function go(index, event) {
    const row = rows()[Math.max(0, Math.min(index, rows().length - 1))];
    if (!row) return;
    if (event.shiftKey) selection.extend(row.id, rows());
    else if (event.ctrlKey || event.metaKey) selection.activate(row.id);
    else selection.choose(row.id);
    tree.showActive();
  }

  /**
   * @param {KeyboardEvent} event
   * @param {Item} item
   */
  function fold(event, item) {
    if (event.key === "ArrowRight") {
      if (!isOpen(item)) setOpen(item, true);
      else if (item.children.length) return go(here() + 1, event);
    } else if (isOpen(item)) setOpen(item, false);
    else if (item.parent) return go(rows().indexOf(item.parent), event);
    tree.refresh();
  }

  /**
   * @param {KeyboardEvent} event
   * @param {Item} item
   */
  function switchOn(event, item) {
    if (event.ctrlKey || event.metaKey) {
      selection.toggle(item.id);
      tree.refresh();
      return;
    }
    const isOne = !selection.isSelected(item.id);
    const items = (
      isOne ? [item] : [...selection.ids()].flatMap((id) => tree.model().byId.get(id) ?? [])
    ).filter((each) => each.can_edit);
    if (items.length) actions.setEnabled(items, !actions.isEnabled(item), tree.refresh);
  }

  /** @param {KeyboardEvent} event */
  function onKey(event) {
    const item = rows()[here()];
    const { key, altKey, shiftKey } = event;
    const withCtrl = event.ctrlKey || event.metaKey;
    const page = Math.max(1, Math.floor(element.clientHeight / 26) - 1);
    const to = {
      ArrowDown: here() + 1,
      ArrowUp: here() - 1,
      Home: 0,
      End: Infinity,
      PageDown: here() + page,
      PageUp: here() - page,
    }[key];
    if (altKey) {
      if (!WAYS[key] || withCtrl) return false;
      actions.moveBy(tree.model(), selection.ids(), WAYS[key]);
    } else if (to !== undefined) go(to, event);
    else if (!item) return false;
    else if (key === "ArrowLeft" || key === "ArrowRight") fold(event, item);
    else if (key === "Enter") tree.setOpen(item, !isOpen(item));
    else if (key === " ") switchOn(event, item);
    else if (key === "F2") tree.rename(item.id);
    else if (key === "Delete" && !shiftKey) actions.remove(tree.model(), rows(), chosen());
    else if (key === "ContextMenu" || (key === "F10" && shiftKey)) tree.openMenu(item.id);
    else if (withCtrl && key === "a") selectAll();
    else if (withCtrl && key === "c" && chosen().length) actions.copyAsYaml(chosen());
    else return false; // letters are for tools, wherever the focus is
    return true;
  }

  function selectAll() {
    for (const { id } of tree.model().items) selection.ids().add(id);
    tree.refresh();
  }

  element.addEventListener("keydown", (event) => {
    if (
      /** @type {Element} */ (event.target).getAttribute("role") !== "treeitem" ||
      event.isComposing
    )
      return;
    if (!onKey(event)) return;
    event.preventDefault();
    event.stopPropagation();
  });
}
