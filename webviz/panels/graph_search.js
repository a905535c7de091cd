// The field that finds boxes of a graph; Enter goes from one to the next.

import { searchField } from "webviz/controls/fields.js";
import { computed, signal } from "webviz/signals.js";
import { finder } from "./graph_view.js";

/** @import {Box} from "./graph_layout.js" */

/**
 * Returns `{element, isFound()}`: `isFound` is as of `finder`, and is read in effects.
 *
 * @param {{boxes: () => Iterable<Box>, goTo: (box: Box) => void}} graph
 */
export function makeSearch({ boxes, goTo }) {
  const text = signal("");
  const isFound = computed(() => finder(text.value));
  let hit = -1; // of those that are found

  function onInput() {
    hit = -1;
    text.value = element.value;
  }

  /** @param {KeyboardEvent} event */
  function onKey(event) {
    if (event.key !== "Enter") return;
    event.preventDefault();
    const matches = [...boxes()].filter(isFound.value ?? (() => false));
    if (!matches.length) return;
    hit = (hit + (event.shiftKey ? -1 : 1) + matches.length) % matches.length;
    goTo(matches[hit]);
  }

  /** @type {HTMLInputElement} */
  const element = searchField("Find nodes and topics", onInput, { onkeydown: onKey });
  return { element, isFound: () => isFound.value };
}
