// The dock beside the scene, below it where there is little room: a pane for each display with a picture.

import { splitter } from "../docks/splitter.js";
import { el, setChildren } from "../dom.js";
import { recall, remember } from "../remember.js";
import { watch } from "../stores.js";
import * as frames from "./frames.js";
import { makePane } from "./pane.js";

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
  /** @type {Map<string, ReturnType<typeof makePane>>} */
  const panes = new Map();
  const list = el("div", { class: "wv-panes" });
  const side = /** @type {HTMLElement} */ (page.querySelector(".wv-side"));
  const beside = /** @type {HTMLElement} */ (page.querySelector(".wv-beside"));
  let size = recall("dock", /** @type {number | null} */ (null));

  // What the panels leave; on a phone they lie over it.
  const width = () => innerWidth - side.offsetWidth - beside.offsetWidth;
  const isBelow = () => narrow.matches || width() < LEAST_ROOM;
  const room = () => (isBelow() ? innerHeight : width());
  const wanted = () =>
    Math.max(
      MIN_SIZE,
      Math.min(size ?? STANDARD, (size === null ? FAIR_SHARE : MAX_SHARE) * room()),
    );

  const border = splitter({
    label: "Size of the images",
    along: () => (isBelow() ? "y" : "x"),
    size: wanted,
    move: (pixels, before) => resize(before - pixels),
    end: keep,
    class: "wv-dock-border",
    ondblclick: () => {
      resize(null);
      keep();
    },
  });
  const dock = el(
    "aside",
    { class: "wv-dock", "aria-label": "Images", hidden: true },
    list,
    border,
  );
  page.append(dock);

  watch("panes", (rows) => {
    for (const [id, pane] of panes) {
      if (rows.get("order")?.includes(id)) continue;
      pane.close();
      panes.delete(id);
    }
    const order = rows.get("order") ?? [];
    for (const id of order) {
      const row = rows.get(id);
      if (!row) continue;
      const pane = panes.get(id) ?? makePane(id, layOut, Boolean(row.hidden));
      panes.set(id, pane);
      pane.update(row);
    }
    setChildren(
      list,
      [...order].flatMap((id) => panes.get(id)?.element ?? []),
    );
    layOut();
  });
  narrow.addEventListener("change", layOut);
  window.addEventListener("resize", layOut);
  new ResizeObserver(frames.refresh).observe(list);
  for (const each of [side, beside]) new ResizeObserver(layOut).observe(each);

  function layOut() {
    const open = [...panes.values()].some((pane) => !pane.isFolded());
    dock.hidden = !panes.size;
    const full = Math.round(wanted());
    const low = open ? full : Math.min(full, FOLDED * panes.size);
    const style = document.documentElement.style;
    const isShown = panes.size > 0;
    const below = isBelow();
    dock.toggleAttribute("data-below", below);
    style.setProperty("--wv-dock-width", `${isShown && !below ? full : 0}px`);
    style.setProperty("--wv-dock-height", `${isShown && below ? low : 0}px`);
    border.setAttribute("aria-orientation", below ? "horizontal" : "vertical");
    frames.refresh();
  }

  /** @param {number | null} pixels */
  function resize(pixels) {
    size = pixels === null ? null : Math.max(MIN_SIZE, Math.round(pixels));
    layOut();
  }

  function keep() {
    remember("dock", size);
  }
}
