// Legends of colours, for each display that colours by value.

import { el, set, setChildren, setText } from "../dom.js";
import { watch } from "../stores.js";

const MAX_CARDS = 4;

export function build() {
  const list = el("div", { class: "wv-legends" });
  const cards = new Map();
  watch("legend", (scales, changed) => {
    for (const id of changed) {
      if (!scales.has(id)) cards.delete(id);
      else show(cards.get(id) ?? add(id), scales.get(id));
    }
    setChildren(list, [...cards.values()].slice(0, MAX_CARDS).map(({ element }) => element));
  });

  function add(id) {
    const card = { title: el("div"), bar: el("div", { class: "wv-legend-bar" }) };
    card.low = el("span");
    card.label = el("span");
    card.high = el("span");
    const bounds = el("div", { class: "wv-legend-bounds" }, card.low, card.label, card.high);
    card.element = el("div", { class: "wv-card wv-legend" }, card.title, card.bar, bounds);
    cards.set(id, card);
    return card;
  }
  return list;
}

function show(card, { title, label, low, high, colors }) {
  setText(card.title, title);
  set(card.title, { "data-tip": title });
  setText(card.label, label);
  setText(card.low, String(low));
  setText(card.high, String(high));
  const stops = colors.map((rgb) => `rgb(${rgb.join()})`).join();
  if (card.stops !== stops) card.bar.style.background = `linear-gradient(to right, ${stops})`;
  card.stops = stops;
}
