// Layout of the side: its width, and whether it is folded away.

import { reveal } from "webviz/docks/docks.js";
import { splitter } from "webviz/docks/splitter.js";
import { el } from "webviz/dom.js";
import { recall, remember } from "webviz/remember.js";
import * as viser from "webviz/viser_page.js";

const MIN_WIDTH = 240;
const MAX_SHARE = 0.7;
const FIT_MS = 1000;

const narrow = matchMedia("(max-width: 640px)");

export function install() {
  document.documentElement.style.setProperty("--wv-scrollbar", `${scrollbarWidth()}px`);
  fold(narrow.matches || recall("folded", false));
  narrow.addEventListener("change", () => fold(narrow.matches || recall("folded", false)));
  setWidth(recall("width", 320));
  // Not when `fit` says so, perhaps while the border is dragged.
  window.addEventListener("resize", ({ isTrusted }) => isTrusted && setWidth(recall("width", 320)));
  setInterval(fit, FIT_MS);
}

// viser's canvas measures its place when that changes, but misses a change while it is being made.
function fit() {
  const isLate = viser.canvas().clientWidth !== document.getElementById("root")?.clientWidth;
  if (isLate) window.dispatchEvent(new Event("resize"));
}

// A thin one: nothing where it lies over what it scrolls, as on phones.
function scrollbarWidth() {
  const probe = el("div", {
    style: "position: absolute; width: 50px; overflow: auto; scrollbar-gutter: stable",
  });
  document.getElementById("webviz")?.append(probe);
  const width = probe.offsetWidth - probe.clientWidth;
  probe.remove();
  return width;
}

const isFolded = () => document.body.classList.contains("wv-folded");

/**
 * Folds the side away, or shows it again. On a phone it lies over the scene, and begins folded.
 *
 * @param {boolean} [next]
 */
export function fold(next = !isFolded()) {
  if (next !== isFolded()) document.body.classList.toggle("wv-folded", next);
  if (!narrow.matches) remember("folded", next);
}

/**
 * Opens the tab of a panel by its name.
 *
 * @param {string} name
 */
export function openPanel(name) {
  if (reveal(name)) return;
  fold(false);
  document.getElementById(`wv-tab-${name}`)?.click();
}

/** @param {number} pixels */
function setWidth(pixels) {
  const width = Math.max(MIN_WIDTH, Math.min(pixels, innerWidth * MAX_SHARE));
  document.documentElement.style.setProperty("--wv-width", `${Math.round(width)}px`);
  return width;
}

/**
 * The border of the side, to be dragged or moved by arrow keys.
 *
 * @param {HTMLElement} side
 */
export const border = (side) =>
  splitter({
    label: "Width of the panels",
    along: () => "x",
    size: () => side.offsetWidth,
    move: (pixels, before) => setWidth(before + pixels),
    end: () => remember("width", side.offsetWidth),
    class: "wv-border",
    ondblclick: () => remember("width", setWidth(320)),
  });
