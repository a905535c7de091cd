// The head of a pane: its title, facts about it, and its buttons.

import { el } from "webviz/dom.js";
import { icon } from "webviz/icons.js";

/**
 * The pane of a head: functions are read in effects, and its buttons call the last three.
 *
 * @typedef {{
 *   title: () => string, about: () => string, facts: () => string, zoom: () => number,
 *   isFolded: () => boolean, isFull: () => boolean,
 *   toggle: () => void, toggleFull: () => void, unzoom: () => void,
 * }} HeadOf
 */

/** @param {HeadOf} pane */
export function makeHead({ title, isFolded, isFull, zoom: factor, ...pane }) {
  const fold = el(
    "button",
    {
      class: "wv-icon wv-pane-fold",
      type: "button",
      "aria-expanded": () => String(!isFolded()),
      "aria-label": () => `${isFolded() ? "Expand" : "Collapse"} ${title()}`,
      onclick: pane.toggle,
    },
    icon("chevron"),
  );
  const facts = el("span", { class: "wv-quiet" }, pane.facts);
  const zoom = el(
    "button",
    {
      class: "wv-button wv-pane-zoom",
      type: "button",
      hidden: () => factor() === 1,
      "aria-label": () => `Reset the zoom of ${title()}`,
      "data-tip": "Reset the zoom (double click)",
      onclick: pane.unzoom,
    },
    () => `${factor().toFixed(1)}×`,
  );
  const full = el(
    "button",
    {
      class: "wv-icon",
      type: "button",
      "aria-pressed": () => String(isFull()),
      "aria-label": () => `Full size of ${title()}`,
      "data-tip": () => (isFull() ? "Leave full size (Esc)" : "Full size"),
      onclick: pane.toggleFull,
    },
    icon("fullscreen"),
  );
  const name = el("b", { "data-tip": pane.about }, title);
  return {
    element: el("header", { class: "wv-pane-head" }, fold, name, facts, zoom, full),
    /** Parts of a frame around the pane in its head; the rest it has itself. */
    tools: [facts, zoom],
    /** Takes it back. */
    restore: () => full.before(facts, zoom),
  };
}
