// The head of a pane: its title, facts about it, and its buttons.

import { el, set, setText } from "webviz/dom.js";
import { icon } from "webviz/icons.js";

/**
 * A head, whose buttons call `toggle`, `toggleFull` and `unzoom`.
 *
 * @param {{toggle: () => void, toggleFull: () => void, unzoom: () => void}} pane
 */
export function makeHead({ toggle, toggleFull, unzoom }) {
  const fold = el(
    "button",
    { class: "wv-icon wv-pane-fold", type: "button", onclick: toggle },
    icon("chevron"),
  );
  const name = el("b");
  const facts = el("span", { class: "wv-quiet" });
  const zoom = el("button", {
    class: "wv-button wv-pane-zoom",
    type: "button",
    hidden: true,
    onclick: unzoom,
  });
  const full = el(
    "button",
    { class: "wv-icon", type: "button", onclick: toggleFull },
    icon("fullscreen"),
  );
  return {
    element: el("header", { class: "wv-pane-head" }, fold, name, facts, zoom, full),
    /** Parts of a frame around the pane in its head; the rest it has itself. */
    tools: [facts, zoom],
    /** Takes it back. */
    restore: () => full.before(facts, zoom),
    /** @param {string} text */
    tell: (text) => setText(facts, text),
    /** @param {number} factor */
    showZoom(factor) {
      zoom.hidden = factor === 1;
      setText(zoom, `${factor.toFixed(1)}×`);
    },
    /** @param {{title: string, about: string, isFolded: boolean, isFull: boolean}} pane */
    update({ title, about, isFolded, isFull }) {
      set(fold, {
        "aria-expanded": String(!isFolded),
        "aria-label": `${isFolded ? "Expand" : "Collapse"} ${title}`,
      });
      set(full, {
        "aria-pressed": String(isFull),
        "aria-label": `Full size of ${title}`,
        "data-tip": isFull ? "Leave full size (Esc)" : "Full size",
      });
      set(zoom, {
        "aria-label": `Reset the zoom of ${title}`,
        "data-tip": "Reset the zoom (double click)",
      });
      set(name, { "data-tip": about });
      setText(name, title);
    },
  };
}
