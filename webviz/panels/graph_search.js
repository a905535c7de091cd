// The field that finds boxes of a graph; Enter goes from one to the next.

import { searchField } from "webviz/controls/fields.js";
import { finder } from "./graph_view.js";

/** @import {Box} from "./graph_layout.js" */

/**
 * Returns `{element, isFound()}`: `isFound` is as of `finder`.
 *
 * @param {{boxes: () => Iterable<Box>, changed: () => void, goTo: (box: Box) => void}} graph
 */
export function makeSearch({ boxes, changed, goTo }) {
  let hit = -1; // of those that are found
  const isFound = () => finder(element.value);

  function onInput() {
    hit = -1;
    changed();
  }

  /** @param {KeyboardEvent} event */
  function onKey(event) {
    if (event.key !== "Enter") return;
    event.preventDefault();
    const found = [...boxes()].filter(isFound() ?? (() => false));
    if (!found.length) return;
    hit = (hit + (event.shiftKey ? -1 : 1) + found.length) % found.length;
    goTo(found[hit]);
  }

  const element = searchField("Find nodes and topics", onInput, { onkeydown: onKey });
  return { element, isFound };
}
