// The mark that shows where what is dragged will go: a line between rows, or a frame around a group.

import { el } from "webviz/dom.js";

/** @import {Tree} from "webviz/panels/displays/types.js" */

/**
 * A mark in a tree; it scrolls with the rows.
 *
 * @param {Pick<Tree, "element" | "canvas" | "list">} tree
 */
export function createMark({ element, canvas, list }) {
  const mark = el("div", { class: "wv-tree-drop", "aria-hidden": "true", hidden: true });
  element.append(mark);

  /**
   * @param {number} top
   * @param {number} height
   * @param {number} depth
   */
  function show(top, height, depth) {
    mark.style.top = `${canvas.offsetTop + top}px`;
    mark.style.height = `${height}px`;
    mark.style.setProperty("--depth", String(depth));
    mark.classList.toggle("wv-tree-into", height > 0);
    mark.hidden = false;
  }

  return {
    /**
     * A line below the row with this index, -1 for above all, at a depth.
     *
     * @param {number} index
     * @param {number} depth
     */
    below(index, depth) {
      const { top, height } = index < 0 ? { top: 0, height: 0 } : list.span(index);
      show(top + height, 0, depth);
    },
    /**
     * A frame around the row with this index.
     *
     * @param {number} index
     */
    around(index) {
      const { top, height } = list.span(index);
      show(top, height, 0);
    },
    hide: () => (mark.hidden = true),
  };
}
