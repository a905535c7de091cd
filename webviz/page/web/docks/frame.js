// The frame of a panel that is not in the tabs of the side: its head, and what it shows.

import { needs } from "webviz/access.js";
import { el } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { each, root } from "webviz/signals.js";

/** @import {End, Panel} from "webviz/types.js" */

/**
 * Opens a panel in an element, and puts what belongs to its head into another; returns what ends it,
 * with all effects that it has made.
 *
 * @param {Panel} panel
 * @param {HTMLElement} element
 * @param {HTMLElement} head
 * @returns {End}
 */
export const openIn = (panel, element, head) =>
  root((end) => {
    const close = panel.open(element, head);
    return () => {
      close?.();
      end();
    };
  });

/**
 * A frame; `names` are the panels of its place, which tabs choose.
 *
 * @param {Panel} panel
 * @param {{
 *   name: string, names(): string[], titleOf(name: string): string, choose(name: string): void,
 *   isFull(): boolean, isAlone: boolean, menu(button: HTMLElement): void, full(): void, back(): void,
 *   dragTab(tab: HTMLElement, name: () => string): void,
 * }} place
 */
export function makeFrame(panel, place) {
  const { name, isFull, isAlone, titleOf } = place;
  const fullLabel = () => (isFull() ? "Leave full screen (Escape)" : "Full screen");
  const more = iconButton("dots", "More for this panel", () => place.menu(more), {
    hidden: isAlone,
    "aria-haspopup": "menu",
  });
  const whole = iconButton("fullscreen", "Full screen", place.full, {
    hidden: isAlone,
    "aria-pressed": () => String(isFull()),
    "aria-label": fullLabel,
    tip: null,
    "data-tip": fullLabel,
  });
  const tools = el("div", { class: "wv-panel-tools" });
  const title = el("b", {}, () => titleOf(name));
  const tabs = tabList(place);
  const head = el(
    "header",
    { class: "wv-docked-head", ondblclick: place.full },
    () => (place.names().length > 1 ? tabs : title),
    tools,
    el("span", { class: "wv-docked-acts" }, whole, more, closeButton(panel, place)),
  );
  const body = el("div", { class: "wv-panel" });
  const element = el(
    "section",
    {
      class: () => (isFull() ? "wv-docked wv-docked-full" : "wv-docked"),
      "aria-label": () => titleOf(name),
      "data-panel": panel.name,
    },
    head,
    body,
  );
  return { element, head, end: openIn(panel, body, tools) };
}

/**
 * A panel that was added is removed, and others go back to the tabs.
 *
 * @param {Panel} panel
 * @param {{isAlone: boolean, back(): void}} place
 */
function closeButton({ remove, home }, { isAlone, back }) {
  const options = { hidden: isAlone };
  if (!remove) return iconButton("close", home ?? "Back to the tabs", back, options);
  return needs("RemovePanel", iconButton("close", "Remove panel", remove, options));
}

/**
 * The tabs of the panels of a place.
 *
 * @param {Parameters<typeof makeFrame>[1]} place
 */
function tabList({ name, names, titleOf, choose, dragTab }) {
  /** @param {KeyboardEvent} event */
  function onkeydown(event) {
    const change = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!change) return;
    event.preventDefault();
    event.stopPropagation(); // viser's camera turns by them
    const all = names();
    choose(all[(all.indexOf(name) + change + all.length) % all.length]);
  }
  /** @param {unknown} _ @param {string} each */
  function tab(_, each) {
    const button = el(
      "button",
      {
        type: "button",
        role: "tab",
        "aria-selected": String(each === name),
        tabindex: each === name ? 0 : -1,
        "data-tab": each,
        onclick: () => choose(each),
        onkeydown,
      },
      () => titleOf(each),
    );
    dragTab(button, () => each);
    return button;
  }
  return el(
    "div",
    { class: "wv-tabs", role: "tablist", "aria-label": "Panels here" },
    each(names, (each) => each, tab),
  );
}
