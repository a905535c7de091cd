// Below the tree: statuses and properties of the display that is selected, with a border to drag.

import { splitter } from "webviz/docks/splitter.js";
import { el } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { sanitized } from "webviz/sanitize.js";
import { recall, remember } from "webviz/remember.js";
import { computed, effect, signal, untracked } from "webviz/signals.js";
import { duplicate, focus } from "webviz/panels/displays/actions.js";
import { GLOBAL } from "webviz/panels/displays/model.js";
import { globalOptions, propertiesOf } from "webviz/panels/displays/properties.js";
import { severalProperties } from "webviz/panels/displays/several.js";

/** @import {Item} from "webviz/panels/displays/types.js" */

const LEAST = 90; // pixels of the tree and of the properties
const HEIGHT_KEY = "displays.height";
const OPEN_KEY = "displays.details";

/** Builds the border and what is below it. */
export function buildDetails() {
  const isOpen = signal(recall(OPEN_KEY, true));
  effect(() => remember(OPEN_KEY, isOpen.value));
  const items = signal(/** @type {Item[]} */ ([]));
  const ids = computed(() => JSON.stringify(isOpen.value ? items.value.map(({ id }) => id) : []));
  const names = () => items.value.map(({ name }) => sanitized(name));
  const isGlobal = () => items.value[0]?.id === GLOBAL;
  const title = () => (names().length === 1 ? names()[0] : `${names().length} displays`);
  const close = () => (isOpen.value = false);
  const border = splitter({
    label: "Height of the properties",
    along: () => "y",
    size: () => element.offsetHeight,
    move: (pixels, before) => setHeight(before - pixels),
    end: () => remember(HEIGHT_KEY, element.offsetHeight),
    step: 24,
    class: "wv-details-border",
    "data-tip": "Drag, or double click to close",
    ondblclick: close,
  });
  const body = el("div", { class: "wv-details-body" }, () => {
    const idList = JSON.parse(ids.value);
    return untracked(() => contentOf(idList));
  });
  effect(() => {
    if (ids.value) body.scrollTop = 0;
  });
  /** @type {HTMLElement} */
  const element = el(
    "section",
    { class: "wv-details", "aria-label": "Properties", hidden: () => ids.value === "[]" },
    border,
    el(
      "div",
      { class: "wv-details-head" },
      el("h2", { class: "wv-details-title", "data-tip": () => names().join("\n") }, title),
      iconButton("focus", "Focus", () => focus(items.value[0]), {
        hidden: () => isGlobal() || items.value.length > 1,
      }),
      iconButton("copy", "Duplicate", () => duplicate(items.value), { hidden: isGlobal }),
      iconButton("close", "Close properties", close),
    ),
    body,
  );

  /**
   * As a share of what both have, it fits when the window becomes smaller.
   *
   * @param {number} pixels
   */
  function setHeight(pixels) {
    element.style.height = `clamp(${LEAST}px, ${Math.round(pixels)}px, 100% - ${LEAST + 40}px)`;
  }

  setHeight(recall(HEIGHT_KEY, 280));
  return { element, items, isOpen };
}

/** @param {string[]} ids */
function contentOf(ids) {
  if (ids.length > 1) return severalProperties(ids);
  const [id] = ids;
  return !id ? [] : id === GLOBAL ? globalOptions() : propertiesOf(id);
}
