// Below the tree: statuses and properties of the display that is selected, with a border to drag.

import { el, set, setText } from "../../dom.js";
import { icon } from "../../icons.js";
import { plain } from "../../plain.js";
import { recall, remember } from "../../remember.js";
import { duplicate, focus } from "./actions.js";
import { GLOBAL } from "./model.js";
import { globalOptions, properties } from "./properties.js";

const LEAST = 90; // pixels of the tree and of the properties
const STEP = 24;
const HEIGHT_KEY = "displays.height";
const OPEN_KEY = "displays.details";

/** Builds the border and what is below it; `panel` is what both share with the tree. */
export function buildDetails(panel) {
  let shown = null;
  let end = null;
  let isOpen = recall(OPEN_KEY, true);
  const title = el("h2", { class: "wv-details-title" });
  const button = (name, label, run) =>
    el("button", { type: "button", class: "wv-icon", "aria-label": label, "data-tip": label, onclick: run },
      icon(name));
  const tools = [
    button("focus", "Focus", () => focus(shown)),
    button("copy", "Duplicate", () => duplicate([shown])),
  ];
  const close = button("close", "Close properties", () => setOpen(false));
  const head = el("div", { class: "wv-details-head" }, title, ...tools, close);
  const body = el("div", { class: "wv-details-body" });
  const border = el("div", {
    class: "wv-details-border", role: "separator", tabindex: 0, "aria-orientation": "horizontal",
    "aria-label": "Height of the properties", "data-tip": "Drag, or double click to close",
    ondblclick: () => setOpen(false),
    onpointerdown: (event) => border.setPointerCapture(event.pointerId),
    onpointermove: (event) => {
      const { bottom } = panel.getBoundingClientRect();
      if (border.hasPointerCapture(event.pointerId)) setHeight(bottom - event.clientY);
    },
    onpointerup: () => remember(HEIGHT_KEY, element.offsetHeight),
    onkeydown: (event) => {
      const change = { ArrowUp: STEP, ArrowDown: -STEP }[event.key];
      if (!change) return;
      event.preventDefault();
      setHeight(element.offsetHeight + change);
      remember(HEIGHT_KEY, element.offsetHeight);
    },
  });
  const element = el("section", { class: "wv-details", "aria-label": "Properties" }, border, head, body);
  setHeight(recall(HEIGHT_KEY, 280));

  // As a share of what both have, it fits when the window becomes smaller.
  function setHeight(pixels) {
    element.style.height = `clamp(${LEAST}px, ${Math.round(pixels)}px, 100% - ${LEAST + 40}px)`;
  }

  function setOpen(open) {
    isOpen = open;
    remember(OPEN_KEY, open);
    update(shown);
  }

  function fill(item) {
    end?.();
    end = null;
    body.replaceChildren();
    body.scrollTop = 0;
    if (item) end = item.id === GLOBAL ? globalOptions(body) : properties(body, item.id);
  }

  let filledWith = null;
  function update(item) {
    shown = item;
    const wanted = isOpen ? item : null;
    set(element, { hidden: !wanted });
    if (wanted?.id !== filledWith) {
      filledWith = wanted?.id;
      fill(wanted);
    }
    if (!wanted) return;
    setText(title, plain(item.name));
    set(title, { "data-tip": plain(item.name) });
    for (const tool of tools) set(tool, { hidden: item.id === GLOBAL });
  }

  update(null);
  return { element, update, setOpen, isOpen: () => isOpen, close: () => fill(null) };
}
