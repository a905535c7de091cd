// The pointer over the tree: clicks on rows and their parts, the menu, and the row that it rests on.

import { set } from "webviz/dom.js";
import * as actions from "webviz/panels/displays/actions.js";
import { isOpen } from "webviz/panels/displays/folding.js";
import * as selection from "webviz/panels/displays/selection.js";

/** @import {Tree} from "webviz/panels/displays/types.js" */

export const HOVER_MS = 250;
const SEEN_MS = 400; // a second click must find the row where the first one did

/**
 * Answers to the pointer and to what has the focus in a tree; see `tree.js` for what is asked of that.
 * Returns `{hovered(), end()}`: the id of the row under the mouse, null for none.
 *
 * @param {HTMLElement} canvas
 * @param {Tree} tree
 */
export function listenToPointer(canvas, tree) {
  /** @type {string | null} */
  let hovered = null;
  let timer = 0;

  /** @param {PointerEvent} event */
  function onHover(event) {
    const name = /** @type {Element} */ (event.target).closest(".wv-tree-name");
    if (name)
      set(name, { "data-tip": name.scrollWidth > name.clientWidth ? name.textContent : null });
    clearTimeout(timer);
    const id = event.pointerType === "mouse" ? (tree.itemAt(event.target)?.id ?? null) : null;
    if (id === hovered) return;
    timer = setTimeout(() => {
      hovered = id;
      tree.refresh();
    }, HOVER_MS);
  }

  set(canvas, {
    onclick: (event) => click(tree, event),
    ondblclick: (event) => {
      const item = tree.itemAt(event.target);
      if (item && !event.target.closest("[data-part]")) tree.rename(item.id);
    },
    onchange: ({ target }) => {
      const item = target.dataset.part === "box" && tree.itemAt(target);
      if (!item) return;
      selection.activate(item.id);
      actions.setEnabled([item], target.checked, () => tree.refresh());
      tree.focus();
    },
    oncontextmenu: (event) => {
      const item = tree.itemAt(event.target);
      if (!item) return;
      event.preventDefault();
      if (event.pointerType !== "touch") tree.openMenu(item.id, event.clientX, event.clientY);
    },
    onpointerover: onHover,
    onpointerleave: onHover,
    onfocusin: ({ target }) => {
      const item = target.getAttribute("role") === "treeitem" && tree.itemAt(target);
      if (item && item.id !== selection.active()) {
        selection.activate(item.id);
        tree.refresh();
      }
    },
  });
  return { hovered: () => hovered, end: () => clearTimeout(timer) };
}

/**
 * @param {Tree} tree
 * @param {PointerEvent} event
 */
function click(tree, event) {
  const item = tree.itemAt(event.target);
  const target = /** @type {Element} */ (event.target);
  const part = target.closest("[data-part]")?.getAttribute("data-part");
  if (!item || part === "box" || part === "remedy") return;
  if (part === "fold") {
    selection.activate(item.id);
    tree.setOpen(item, !isOpen(item));
    return tree.focus();
  }
  if (part === "more") return tree.openMenu(item.id, event.clientX, event.clientY);
  if (event.detail > 1) return;
  if (event.shiftKey) selection.extend(item.id, tree.rows());
  else if (event.ctrlKey || event.metaKey || selection.severalAtOnce()) selection.toggle(item.id);
  else selection.choose(item.id);
  tree.refresh();
  tree.focus();
  setTimeout(() => item.id === selection.active() && tree.list.reveal(item.id), SEEN_MS);
}
