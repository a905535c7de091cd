// The panels beside, below and over the scene, as the layout says that all browsers share.

import { why } from "../access.js";
import { act } from "../act.js";
import { el, setChildren } from "../dom.js";
import { listeners } from "../listeners.js";
import { openMenuBelow } from "../controls/menu.js";
import { watch } from "../stores.js";
import { corner } from "./corner.js";
import { draggable } from "./drag.js";
import { makeFrame } from "./frame.js";
import {
  EMPTY,
  floated,
  layoutOf,
  moved,
  namesOf,
  placeOf,
  shared,
  sized,
  sizesIn,
  without,
} from "./places.js";
import { splitter } from "./splitter.js";
import { alone, layoutName, openWindow } from "./windows.js";

/** @import {Panel} from "../types.js" */
/** @import {MenuItem} from "../controls/menu.js" */
/** @import {Boxes, Layout, Target} from "./places.js" */
/** @typedef {ReturnType<typeof makeFrame>} Frame */

const PLUGIN = "plugin-";

const narrow = matchMedia("(max-width: 640px)");
/** @type {Layout} */
let layout = EMPTY;
/** The one of all browsers, from which that of a watcher may differ. */
let common = EMPTY;
/** @type {readonly {name: string, is_shown: boolean}[]} */
let saved = [];
let full = alone;
let placed = ""; // names of the panels that the listeners know of
/** @type {Panel[]} */
let panels = [];
/** @type {Map<string, Frame>} */
const frames = new Map();
/** @type {Map<string, HTMLElement>} */
const splitters = new Map();
const changes = listeners();
const beside = el("div", { class: "wv-beside", hidden: true });
const below = el("div", { class: "wv-below", hidden: true });
const floats = el("div", { class: "wv-floats" });
const unknown = el("p", { class: "wv-empty", hidden: true }, `Unknown panel \`${alone}\`.`);
const besideBorder = border("x", "width", "Width of the panels beside the scene");
const belowBorder = border("y", "height", "Height of the panels below the scene");

/** @param {Panel} panel */
const nameOf = ({ name }) => (name.startsWith(PLUGIN) ? name.slice(PLUGIN.length) : name);

/**
 * Puts the places of panels into the page.
 *
 * @param {HTMLElement} page
 */
export function install(page) {
  page.append(floats, below, beside);
  document.body.classList.toggle("wv-alone", Boolean(alone));
  watch(layoutName ? `layout:${layoutName}` : "layout", (values) => {
    saved = values.get("saved") ?? [];
    layout = common = layoutOf(values);
    draw();
  });
  narrow.addEventListener("change", draw);
  window.addEventListener("resize", measure);
  document.addEventListener("keydown", (event) => {
    const isElsewhere = document.querySelector("#webviz :is(dialog[open], .wv-menu)");
    if (event.key !== "Escape" || !full || alone || isElsewhere) return;
    event.stopPropagation();
    fill("");
  });
}

/** Calls a listener whenever other panels stand outside of the tabs. */
export const onPlaced = changes.on;

/**
 * Says which panels there are.
 *
 * @param {Panel[]} all
 */
export function offer(all) {
  panels = all;
  draw();
}

/**
 * Tells if a panel stands outside of the tabs.
 *
 * @param {Panel} panel
 */
export const isPlaced = (panel) => frames.has(nameOf(panel));

/**
 * Brings a panel to sight that is not in the tabs; false if it is in the tabs.
 *
 * @param {string} name
 */
export function reveal(name) {
  const frame = frames.get(name.startsWith(PLUGIN) ? name.slice(PLUGIN.length) : name);
  if (!frame) return false;
  frame.element.animate([{ outline: "2px solid var(--wv-accent)" }, {}], { duration: 900 });
  return true;
}

/**
 * Lets a tab be dragged out of the tabs.
 *
 * @param {HTMLElement} tab
 * @param {Panel} panel
 */
export function dragTab(tab, panel) {
  const name = nameOf(panel);
  draggable(tab, { boxes: () => boxes(name), drop: (target) => drop(name, target), touch: false });
}

/**
 * The entries of the menu of a panel.
 *
 * @param {Panel} panel
 * @returns {(MenuItem | null)[]}
 */
export function menuOf(panel) {
  const name = nameOf(panel);
  /** @param {Target["place"]} place @param {string} label @returns {MenuItem} */
  const to = (place, label) => ({
    label,
    checked: place === placeOf(layout, name),
    run: () => {
      const at = place === "over" || place === "tabs" ? 0 : layout[place].length;
      arrange(moved(layout, name, { place, at, left: 0.6, top: 0.1 }));
    },
  });
  return [
    ...(narrow.matches
      ? []
      : [
          to("beside", "Beside the scene"),
          to("below", "Below the scene"),
          to("over", "Over the scene"),
          to("tabs", "In the tabs"),
          null,
        ]),
    { label: "Full screen", icon: "fullscreen", run: () => fill(name) },
    { label: "Open in a window", icon: "screen", run: () => openWindow("panel", name) },
  ];
}

/** The saved layouts: names, and whether browsers show them. */
export const savedLayouts = () => saved;

/** Puts all panels back into the tabs. */
export const clear = () => arrange({ ...layout, beside: [], below: [], over: [] });

/**
 * Shows another layout: everywhere if this page may, else only here.
 *
 * @param {Layout} next
 */
async function arrange(next) {
  layout = next;
  draw();
  if (why("SetLayout")) return;
  const { level } = await act("SetLayout", { layout: next, name: layoutName }, { quiet: true });
  if (level !== "error") return;
  layout = common;
  draw();
}

/** @param {string} name */
function fill(name) {
  full = full === name ? "" : name;
  draw();
}

function draw() {
  const known = new Map(panels.map((panel) => [nameOf(panel), panel]));
  const names = new Set(narrow.matches || alone ? [] : namesOf(layout));
  if (full) names.add(full);
  for (const [name, frame] of frames) {
    if (names.has(name) && known.has(name)) continue;
    frame.close();
    frames.delete(name);
  }
  for (const name of names) {
    const panel = known.get(name);
    if (!panel) continue;
    const frame = frames.get(name) ?? make(panel, name);
    frames.set(name, frame);
    frame.setTitle(panel.title);
    frame.setFull(name === full, name === alone);
  }
  setChildren(beside, row("beside", besideBorder));
  setChildren(below, row("below", belowBorder));
  // Not in place of each other, as the order is what lies on top: a moved element keeps its scroll.
  const over = names.size ? layout.over.filter(({ panel }) => frames.has(panel)) : [];
  const isOut =
    full && frames.has(full) && (placeOf(layout, full) === "tabs" || narrow.matches || alone);
  unknown.hidden = !alone || panels.length === 0 || known.has(alone);
  setChildren(floats, [
    unknown,
    ...[...over.map(({ panel }) => panel), ...(isOut ? [full] : [])].flatMap(
      (name) => frames.get(name)?.element ?? [],
    ),
  ]);
  for (const { panel, ...box } of over) position(panel, box);
  beside.hidden = beside.childElementCount < 2;
  below.hidden = below.childElementCount < 2;
  floats.toggleAttribute("data-full", Boolean(full));
  measure();
  const now = [...frames.keys()].sort().join();
  if (now === placed) return;
  placed = now;
  changes.tell();
}

/**
 * The frames of a row, the border of the row and those between frames.
 *
 * @param {"beside" | "below"} place
 * @param {HTMLElement} edge
 */
function row(place, edge) {
  /** @type {HTMLElement[]} */
  const children = [edge];
  let before = "";
  if (narrow.matches || alone) return children;
  for (const { panel, weight } of layout[place]) {
    const frame = frames.get(panel);
    if (!frame) continue;
    if (before) children.push(between(place, before, panel));
    frame.element.style.cssText = `flex-grow: ${weight}`;
    children.push(frame.element);
    before = panel;
  }
  return children;
}

/**
 * @param {string} name
 * @param {{left: number, top: number, width: number, height: number}} box
 */
function position(name, { left, top, width, height }) {
  const element = frames.get(name)?.element;
  if (!element) return;
  element.style.cssText = "";
  for (const [key, share] of Object.entries({ left, top, width, height }))
    element.style.setProperty(key, `${share * 100}%`);
}

/**
 * @param {Panel} panel
 * @param {string} name
 */
function make(panel, name) {
  const frame = makeFrame(panel, {
    menu: (button) => openMenuBelow(button, menuOf(panel)),
    full: () => alone || fill(name),
    close: () => {
      if (full === name) full = "";
      arrange(without(layout, name));
    },
  });
  draggable(frame.head, {
    boxes: () => (full ? null : boxes(name)),
    drop: (target, grab) => drop(name, target, grab),
    touch: true,
  });
  const resizing = corner(frame.element, {
    move(width, height) {
      const scene = floats.getBoundingClientRect();
      const box = { width: width / scene.width, height: height / scene.height };
      layout = floated(layout, name, box);
      draw();
    },
    end: () => arrange(layout),
  });
  frame.element.append(resizing);
  frame.element.addEventListener("pointerdown", () => raise(name), { capture: true });
  return frame;
}

/**
 * Lets a floating panel be seen above the others; for this page, until the layout changes.
 *
 * @param {string} name
 */
function raise(name) {
  const top = frames.get(name)?.element;
  if (top?.parentElement !== floats) return;
  for (const each of floats.children)
    /** @type {HTMLElement} */ (each).style.zIndex = each === top ? "1" : "";
}

/**
 * @param {"beside" | "below"} place
 * @param {string} panel
 * @param {string} next
 */
function between(place, panel, next) {
  const key = JSON.stringify([place, panel, next]);
  const size = place === "beside" ? "offsetHeight" : "offsetWidth";
  /** @param {string} name */
  const length = (name) => frames.get(name)?.element[size] ?? 0;
  const known = splitters.get(key);
  if (known) return known;
  const made = splitter({
    label: "Size of the panels",
    along: () => (place === "beside" ? "y" : "x"),
    size: () => length(panel),
    move(pixels, before) {
      const both = length(panel) + length(next);
      if (both) layout = shared(layout, place, panel, next, (before + pixels) / both);
      draw();
    },
    end: () => arrange(layout),
  });
  splitters.set(key, made);
  return made;
}

/**
 * The border between a row of panels and the scene.
 *
 * @param {"x" | "y"} along
 * @param {"width" | "height"} key
 * @param {string} label
 */
function border(along, key, label) {
  return splitter({
    label,
    along: () => along,
    size: () => (key === "width" ? beside.offsetWidth : below.offsetHeight),
    move(pixels, before) {
      layout = sized(layout, key, before - pixels);
      measure();
    },
    end: () => arrange(layout),
  });
}

// As much as is left to the scene by what is not a panel.
function measure() {
  const side = document.querySelector(".wv-side")?.clientWidth ?? 0;
  const { width, height } = sizesIn(layout, { width: innerWidth - side, height: innerHeight });
  const style = document.documentElement.style;
  style.setProperty("--wv-beside", beside.hidden ? "0px" : `${Math.round(width)}px`);
  style.setProperty("--wv-below", below.hidden ? "0px" : `${Math.round(height)}px`);
}

/**
 * @param {string} dragged
 * @returns {Boxes | null}
 */
function boxes(dragged) {
  if (narrow.matches || alone) return null;
  const side = document.querySelector(".wv-side");
  /** @param {"beside" | "below"} place */
  const others = (place) =>
    layout[place]
      .filter(({ panel }) => panel !== dragged)
      .flatMap(({ panel }) => frames.get(panel)?.element.getBoundingClientRect() ?? []);
  return {
    side: side?.getBoundingClientRect() ?? new DOMRect(),
    scene: floats.getBoundingClientRect(),
    beside: beside.getBoundingClientRect(),
    below: below.getBoundingClientRect(),
    besideBoxes: others("beside"),
    belowBoxes: others("below"),
  };
}

/**
 * @param {string} name
 * @param {Target} target
 * @param {{x: number, y: number}} [grab]
 */
function drop(name, target, grab = { x: 0, y: 0 }) {
  const scene = floats.getBoundingClientRect();
  const left = target.left - grab.x / scene.width;
  const top = target.top - grab.y / scene.height;
  arrange(moved(layout, name, { ...target, left, top }));
}
