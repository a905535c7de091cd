// Legends of colours, for each display that colours by value.

import { el, set, setChildren, setText } from "../dom.js";
import { watch } from "../stores.js";
import { colorBar } from "../charts/color_bar.js";

/** @import {Scale} from "../contents.js" */

/**
 * @typedef {{title: HTMLElement, bar: ReturnType<typeof colorBar>, low: HTMLElement,
 *   label: HTMLElement, high: HTMLElement, element: HTMLElement}} Card
 */

const MAX_CARDS = 4;

export function build() {
  const list = el("div", { class: "wv-legends" });
  /** @type {Map<string, Card>} */
  const cards = new Map();
  watch("legend", (scales, changed) => {
    for (const id of changed) {
      const scale = scales.get(id);
      if (scale) show(cards.get(id) ?? add(id), scale);
      else cards.delete(id);
    }
    setChildren(
      list,
      [...cards.values()].slice(0, MAX_CARDS).map(({ element }) => element),
    );
  });

  /** @param {string} id */
  function add(id) {
    const title = el("div");
    const bar = colorBar();
    const [low, label, high] = [el("span"), el("span"), el("span")];
    const bounds = el("div", { class: "wv-legend-bounds" }, low, label, high);
    const element = el("div", { class: "wv-card wv-legend" }, title, bar.element, bounds);
    const card = { title, bar, low, label, high, element };
    cards.set(id, card);
    return card;
  }
  return list;
}

/**
 * @param {Card} card
 * @param {Scale} scale
 */
function show(card, { title, label, low, high, colors }) {
  setText(card.title, title);
  set(card.title, { "data-tip": title });
  setText(card.label, label);
  setText(card.low, String(low));
  setText(card.high, String(high));
  card.bar.show(colors);
}
