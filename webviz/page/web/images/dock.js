// The images of displays: a pane for each display with a picture, in the dock beside the scene, below
// it where there is little room, or placed as panels are.

import { splitter } from "webviz/docks/splitter.js";
import { dragTab, isPlaced, offerOthers } from "webviz/docks/docks.js";
import { el, setChildren } from "webviz/dom.js";
import { recall, remember } from "webviz/remember.js";
import { effect, root, signal } from "webviz/signals.js";
import { watch } from "webviz/stores.js";
import * as frames from "webviz/images/frames.js";
import { Pane } from "webviz/images/pane.js";

/** @import {Panel, ValuesOf} from "webviz/types.js" */
/** @typedef {{pane: Pane, panel: Panel}} Image */

const STANDARD = 360;
const MIN_SIZE = 120;
// Of what the panels leave: by itself, and by hand.
const FAIR_SHARE = 0.5;
const MAX_SHARE = 0.75;
const FOLDED = 34;
const LEAST_ROOM = 400; // for scene and images beside each other

const narrow = matchMedia("(max-width: 640px)");

/** @param {HTMLElement} page */
export function install(page) {
  const list = el("div", { class: "wv-panes" });
  const { border, layOut } = sizes(page, list, () => visiblePanes());
  const dock = el(
    "aside",
    { class: "wv-dock", "aria-label": "Images", hidden: true },
    list,
    border,
  );
  page.append(dock);
  const images = follow(layOut);
  const visiblePanes = () =>
    images.value.filter(({ panel }) => !isPlaced(panel)).map(({ pane }) => pane);
  effect(() => offerOthers(images.value.map(({ panel }) => panel)));
  effect(() => {
    const panes = visiblePanes();
    setChildren(
      list,
      panes.map(({ element }) => element),
    );
    layOut();
  });
}

/**
 * The images that there are, in their order.
 *
 * @param {() => void} changed
 */
function follow(changed) {
  /** @type {Map<string, Pane>} */
  const panes = new Map();
  const images = signal(/** @type {Image[]} */ ([]));
  watch("panes", (rows) => {
    const order = rows.get("order") ?? [];
    for (const [id, pane] of panes) {
      if (order.includes(id)) continue;
      pane.close();
      pane.element.remove();
      panes.delete(id);
    }
    /** @type {Map<string, number>} */
    const names = new Map();
    images.value = order.flatMap((id) => {
      const row = rows.get(id);
      if (!row) return [];
      const pane =
        panes.get(id) ?? root((end) => new Pane(id, Boolean(row.hidden), { changed, end }));
      if (!panes.has(id)) dragTab(pane.head, () => nameOf(pane));
      panes.set(id, pane);
      pane.update(row);
      const number = (names.get(row.name) ?? 0) + 1;
      names.set(row.name, number);
      const name = `image:${row.name}${number > 1 ? ` ${number}` : ""}`;
      return [{ pane, panel: panelOf(pane, name) }];
    });
  });
  return images;

  /** @param {Image["pane"]} pane */
  function nameOf(pane) {
    return images.value.find((each) => each.pane === pane)?.panel.name ?? "";
  }
}

/**
 * @param {Image["pane"]} pane
 * @param {string} name
 * @returns {Panel}
 */
const panelOf = (pane, name) => ({
  name,
  title: pane.title(),
  home: "With the images",
  open: (place, tools) => pane.openIn(place, tools),
});

/**
 * The size of the dock, which its border changes.
 *
 * @param {HTMLElement} page
 * @param {HTMLElement} list
 * @param {() => Image["pane"][]} visiblePanes
 */
function sizes(page, list, visiblePanes) {
  const side = /** @type {HTMLElement} */ (page.querySelector(".wv-side"));
  const beside = /** @type {HTMLElement} */ (page.querySelector(".wv-beside"));
  let size = recall("dock", /** @type {number | null} */ (null));
  // What the panels leave; on a phone they lie over it.
  const width = () => innerWidth - side.offsetWidth - beside.offsetWidth;
  const isBelow = () => narrow.matches || width() < LEAST_ROOM;
  const room = () => (isBelow() ? innerHeight : width());
  const preferredSize = () =>
    Math.max(
      MIN_SIZE,
      Math.min(size ?? STANDARD, (size === null ? FAIR_SHARE : MAX_SHARE) * room()),
    );
  const border = splitter({
    label: "Size of the images",
    along: () => (isBelow() ? "y" : "x"),
    size: preferredSize,
    move: (pixels, before) => resize(before - pixels),
    end: () => remember("dock", size),
    class: "wv-dock-border",
    ondblclick() {
      resize(null);
      remember("dock", size);
    },
  });
  narrow.addEventListener("change", layOut);
  window.addEventListener("resize", layOut);
  new ResizeObserver(frames.refresh).observe(list);
  for (const each of [side, beside]) new ResizeObserver(layOut).observe(each);
  return { border, layOut };

  function layOut() {
    const panes = visiblePanes();
    const full = Math.round(preferredSize());
    const low = panes.every((pane) => pane.isFolded())
      ? Math.min(full, FOLDED * panes.length)
      : full;
    const below = isBelow();
    const dock = list.parentElement;
    if (dock) dock.hidden = !panes.length;
    dock?.toggleAttribute("data-below", below);
    const style = document.documentElement.style;
    style.setProperty("--wv-dock-width", `${panes.length && !below ? full : 0}px`);
    style.setProperty("--wv-dock-height", `${panes.length && below ? low : 0}px`);
    border.setAttribute("aria-orientation", below ? "horizontal" : "vertical");
    frames.refresh();
  }

  /** @param {number | null} pixels */
  function resize(pixels) {
    size = pixels === null ? null : Math.max(MIN_SIZE, Math.round(pixels));
    layOut();
  }
}
