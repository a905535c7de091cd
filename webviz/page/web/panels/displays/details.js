// Below the tree: statuses and properties of the display that is selected, with a border to drag.

import { splitter } from "../../docks/splitter.js";
import { el, set, setText } from "../../dom.js";
import { iconButton } from "../../icons.js";
import { sanitized } from "../../sanitize.js";
import { recall, remember } from "../../remember.js";
import { duplicate, focus } from "./actions.js";
import { GLOBAL } from "./model.js";
import { globalOptions, properties } from "./properties.js";
import { severalProperties } from "./several.js";

/** @import {Item} from "./types.js" */

const LEAST = 90; // pixels of the tree and of the properties
const HEIGHT_KEY = "displays.height";
const OPEN_KEY = "displays.details";

/** Builds the border and what is below it. */
export function buildDetails() {
  /** @type {Item[]} */
  let shown = [];
  /** @type {(() => void) | null} */
  let end = null;
  let isOpen = recall(OPEN_KEY, true);
  const title = el("h2", { class: "wv-details-title" });
  const tools = [
    iconButton("focus", "Focus", () => focus(shown[0])),
    iconButton("copy", "Duplicate", () => duplicate(shown)),
  ];
  const close = iconButton("close", "Close properties", () => setOpen(false));
  const head = el("div", { class: "wv-details-head" }, title, ...tools, close);
  const body = el("div", { class: "wv-details-body" });
  const border = splitter({
    label: "Height of the properties",
    along: () => "y",
    size: () => element.offsetHeight,
    move: (pixels, before) => setHeight(before - pixels),
    end: () => remember(HEIGHT_KEY, element.offsetHeight),
    step: 24,
    class: "wv-details-border",
    "data-tip": "Drag, or double click to close",
    ondblclick: () => setOpen(false),
  });
  /** @type {HTMLElement} */
  const element = el(
    "section",
    { class: "wv-details", "aria-label": "Properties" },
    border,
    head,
    body,
  );
  setHeight(recall(HEIGHT_KEY, 280));

  /**
   * As a share of what both have, it fits when the window becomes smaller.
   *
   * @param {number} pixels
   */
  function setHeight(pixels) {
    element.style.height = `clamp(${LEAST}px, ${Math.round(pixels)}px, 100% - ${LEAST + 40}px)`;
  }

  /** @param {boolean} open */
  function setOpen(open) {
    isOpen = open;
    remember(OPEN_KEY, open);
    update(shown);
  }

  /** @param {string[]} ids */
  function fill(ids) {
    end?.();
    end = null;
    body.replaceChildren();
    body.scrollTop = 0;
    if (ids.length > 1) end = severalProperties(body, ids);
    else if (ids.length) end = ids[0] === GLOBAL ? globalOptions(body) : properties(body, ids[0]);
  }

  let filledWith = "";
  /** @param {Item[]} items */
  function update(items) {
    shown = items;
    const ids = isOpen ? items.map(({ id }) => id) : [];
    set(element, { hidden: !ids.length });
    if (JSON.stringify(ids) !== filledWith) {
      filledWith = JSON.stringify(ids);
      fill(ids);
    }
    if (!ids.length) return;
    const names = items.map(({ name }) => sanitized(name));
    setText(title, names.length === 1 ? names[0] : `${names.length} displays`);
    set(title, { "data-tip": names.join("\n") });
    for (const tool of tools) set(tool, { hidden: ids[0] === GLOBAL });
    set(tools[0], { hidden: ids[0] === GLOBAL || ids.length > 1 });
  }

  update([]);
  return { element, update, setOpen, isOpen: () => isOpen, close: () => fill([]) };
}
