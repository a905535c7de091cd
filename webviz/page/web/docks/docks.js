// The panels beside, below and over the scene, as the layout says that all browsers share.

import { el, setChildren } from "webviz/dom.js";
import { command } from "webviz/commands.js";
import { openMenuBelow } from "webviz/controls/menu.js";
import { each, effect, owned, signal, untracked } from "webviz/signals.js";
import { watch } from "webviz/stores.js";
import { corner } from "webviz/docks/corner.js";
import { draggable } from "webviz/docks/drag.js";
import { makeFrame } from "webviz/docks/frame.js";
import { floated, layoutOf, moved, placeOf, sizesIn, without } from "webviz/docks/places.js";
import { between, border } from "webviz/docks/borders.js";
import {
  arrange,
  choose,
  fill,
  floating,
  full,
  isTabsOnly,
  panelsByName,
  layout,
  others,
  panels,
  placed,
  placesOf,
  saved,
  shortName,
  take,
  templates,
  visible,
} from "webviz/docks/state.js";
import { alone, layoutName, openWindow } from "webviz/docks/windows.js";

/** @import {Panel} from "webviz/types.js" */
/** @import {MenuItem} from "webviz/controls/menu.js" */
/** @import {Signal} from "webviz/signals.js" */
/** @import {Boxes, PanelBox, Target} from "webviz/docks/places.js" */
/** @typedef {{name: string, element: HTMLElement}} Frame */

const beside = el("div", { class: "wv-beside", hidden: true });
const below = el("div", { class: "wv-below", hidden: true });
const floats = el("div", { class: "wv-floats" });
/** @type {Signal<Map<string, Frame>>} */
const frames = signal(new Map());

/**
 * Puts the places of panels into the page.
 *
 * @param {HTMLElement} page
 */
export function install(page) {
  page.append(floats, below, beside);
  document.body.classList.toggle("wv-alone", Boolean(alone));
  watch(layoutName ? `layout:${layoutName}` : "layout", (values) => {
    saved.value = values.get("saved") ?? [];
    templates.value = values.get("templates") ?? [];
    take(layoutOf(values));
  });
  const rows = each(
    () => visible.value,
    (name) => name,
    ({ value }) => make(value),
  );
  effect(() => {
    frames.value = new Map(rows().map((frame) => [frame.name, frame]));
  });
  const isUnknown = () =>
    Boolean(alone) && panels.value.length > 0 && !panelsByName.value.has(alone);
  const unknown = el(
    "p",
    { class: "wv-empty", hidden: () => !isUnknown() },
    `Unknown panel \`${alone}\`.`,
  );
  effect(() => draw(unknown));
  window.addEventListener("resize", measure);
  command({
    name: "Restore the enlarged panel",
    key: "Escape",
    group: "View",
    isHidden: true,
    isThere: () =>
      full.value !== "" &&
      !alone &&
      !document.querySelector("#webviz :is(dialog[open], .wv-menu, .wv-popover)"),
    run: () => (full.value = ""),
  });
}

/**
 * Says which panels there are.
 *
 * @param {Panel[]} all
 */
export const offer = (all) => (panels.value = all);

/**
 * Says which panels there are that are never tabs.
 *
 * @param {Panel[]} all
 */
export const offerOthers = (all) => (others.value = all);

/**
 * Tells if a panel stands outside of the tabs.
 *
 * @param {Panel} panel
 */
export const isPlaced = (panel) => placed.value.has(shortName(panel.name));

/**
 * Shows a panel that has a place outside of the tabs, or comes into one.
 *
 * @param {string} name
 */
export const bringForward = (name) => choose(shortName(name));

/**
 * Brings a panel to sight that is not in the tabs; false if it is in the tabs.
 *
 * @param {string} name
 */
export function reveal(name) {
  const short = shortName(name);
  if (!untracked(() => placed.value.has(short) && panelsByName.value.has(short))) return false;
  choose(short);
  const element = untracked(() => frames.value.get(short)?.element);
  element?.animate([{ outline: "2px solid var(--wv-accent)" }, {}], { duration: 900 });
  return true;
}

/**
 * Lets a tab be dragged to another place.
 *
 * @param {HTMLElement} tab
 * @param {() => string} name of its panel
 */
export function dragTab(tab, name) {
  const short = () => shortName(name());
  draggable(tab, {
    boxes: () => boxes(short()),
    drop: (to) => drop(short(), to),
    touch: false,
    home: () => panelsByName.value.get(short())?.home,
  });
}

/**
 * The entries of the menu of a panel.
 *
 * @param {Panel} panel
 * @returns {(MenuItem | null)[]}
 */
export function menuOf({ name: long, remove, home = "In the tabs" }) {
  const name = shortName(long);
  /** @param {Target["place"]} place @param {string} label @returns {MenuItem} */
  const to = (place, label) => ({
    label,
    checked: place === placeOf(layout.value, name),
    run: () => {
      const at = place === "over" || place === "tabs" ? 0 : layout.value[place].length;
      arrange(moved(layout.value, name, { place, at, left: 0.6, top: 0.1 }));
    },
  });
  const places = [
    to("beside", "Beside the scene"),
    to("below", "Below the scene"),
    to("over", "Over the scene"),
    to("tabs", home),
    null,
  ];
  /** @type {(MenuItem | null)[]} */
  const removal = [
    null,
    { label: "Remove panel", icon: "trash", needs: "RemovePanel", danger: true, run: remove },
  ];
  return [
    ...(isTabsOnly() ? [] : places),
    { label: "Full screen", icon: "fullscreen", run: () => fill(name) },
    { label: "Open in a window", icon: "screen", run: () => openWindow("panel", name) },
    ...(remove ? removal : []),
  ];
}

export { isTabsOnly, templates } from "webviz/docks/state.js";

/** The saved layouts: names, and whether browsers show them. */
export const savedLayouts = () => saved.value;

/** Puts all panels back into the tabs. */
export const clear = () => arrange({ ...layout.value, beside: [], below: [], over: [] });

/** @param {HTMLElement} unknown */
function draw(unknown) {
  setChildren(beside, row("beside"));
  setChildren(below, row("below"));
  // Not in place of each other, as the order is what lies on top: a moved element keeps its scroll.
  const over = floating().filter(({ panel }) => frames.value.has(panel));
  const names = over.map(({ panel }) => panel);
  const isOut =
    full.value && (isTabsOnly() || ["tabs", "over"].includes(placeOf(layout.value, full.value)));
  if (isOut && !names.includes(full.value)) names.push(full.value);
  setChildren(floats, [unknown, ...names.flatMap((name) => frames.value.get(name)?.element ?? [])]);
  for (const { panel, ...box } of over) position(panel, box);
  beside.hidden = beside.childElementCount < 2;
  below.hidden = below.childElementCount < 2;
  floats.toggleAttribute("data-full", Boolean(full.value));
  measure();
}

const edges = {
  beside: border("x", "width", "Width of the panels beside the scene", () => beside.offsetWidth),
  below: border("y", "height", "Height of the panels below the scene", () => below.offsetHeight),
};

/**
 * The frames of a row, the border of the row and those between frames.
 *
 * @param {"beside" | "below"} place
 */
function row(place) {
  /** @type {HTMLElement[]} */
  const children = [edges[place]];
  /** @type {{key: string, element: HTMLElement} | null} */
  let before = null;
  for (const { key, weight, front } of placesOf(place)) {
    const element = frames.value.get(front)?.element;
    if (!element) continue;
    if (before) children.push(between(place, before.key, key));
    element.style.cssText = `flex-grow: ${weight}`;
    element.dataset.place = key;
    children.push(element);
    before = { key, element };
  }
  return children;
}

/**
 * @param {string} name
 * @param {{left: number, top: number, width: number, height: number}} box
 */
function position(name, { left, top, width, height }) {
  const element = frames.value.get(name)?.element;
  if (!element) return;
  element.style.cssText = "";
  for (const [key, share] of Object.entries({ left, top, width, height }))
    element.style.setProperty(key, `${share * 100}%`);
}

/** @param {string} name */
function make(name) {
  const panel = /** @type {Panel} */ (untracked(() => panelsByName.value.get(name)));
  const panelNow = () => panelsByName.value.get(name) ?? panel;
  const { element, head, end } = makeFrame(panel, {
    name,
    names: () =>
      [...placesOf("beside"), ...placesOf("below")].find(({ names }) => names.includes(name))
        ?.names ?? [name],
    titleOf: (each) => panelsByName.value.get(each)?.title ?? each,
    choose: chooseTab,
    isFull: () => full.value === name,
    isAlone: alone === name,
    menu: (button) => openMenuBelow(button, menuOf(untracked(panelNow))),
    full: () => alone || fill(name),
    back() {
      if (full.value === name) full.value = "";
      arrange(without(layout.value, name));
    },
    dragTab,
  });
  draggable(head, {
    boxes: () => (full.value ? null : boxes(name)),
    drop: (target, grab) => drop(name, target, grab),
    touch: true,
    home: () => panel.home,
  });
  const resizing = corner(element, {
    move(width, height) {
      const scene = floats.getBoundingClientRect();
      const box = { width: width / scene.width, height: height / scene.height };
      layout.value = floated(layout.value, name, box);
    },
    end: () => arrange(layout.value),
  });
  element.append(resizing);
  element.addEventListener("pointerdown", () => raise(name), { capture: true });
  owned(() => {
    end();
    element.remove();
  });
  return { name, element };
}

/**
 * Shows another panel of a place; the focus goes to its tab.
 *
 * @param {string} name
 */
function chooseTab(name) {
  const isFocused = document.activeElement?.matches(".wv-docked-head [role=tab]");
  choose(name);
  const element = frames.value.get(name)?.element;
  /** @type {HTMLElement | null | undefined} */
  const tab = element?.querySelector("[role=tab][aria-selected=true]");
  if (isFocused) tab?.focus();
}

/**
 * Lets a floating panel be seen above the others; for this page, until the layout changes.
 *
 * @param {string} name
 */
function raise(name) {
  const top = frames.value.get(name)?.element;
  if (top?.parentElement !== floats) return;
  for (const each of floats.children)
    /** @type {HTMLElement} */ (each).style.zIndex = each === top ? "1" : "";
}

// As much as is left to the scene by what is not a panel.
function measure() {
  const side = document.querySelector(".wv-side")?.clientWidth ?? 0;
  const room = { width: innerWidth - side, height: innerHeight };
  const { width, height } = sizesIn(layout.value, room);
  const style = document.documentElement.style;
  style.setProperty("--wv-beside", beside.hidden ? "0px" : `${Math.round(width)}px`);
  style.setProperty("--wv-below", below.hidden ? "0px" : `${Math.round(height)}px`);
}

/**
 * @param {string} dragged
 * @returns {Boxes | null}
 */
function boxes(dragged) {
  if (isTabsOnly()) return null;
  const side = document.querySelector(".wv-side");
  const images = document.querySelector(".wv-dock:not([hidden])");
  const home = panelsByName.value.get(dragged)?.home ? (images ?? side) : side;
  /** @param {"beside" | "below"} place @returns {PanelBox[]} */
  const others = (place) =>
    placesOf(place).flatMap(({ names, front }) => {
      const panel = names.find((name) => name !== dragged);
      const element = frames.value.get(front)?.element;
      if (panel === undefined || !element) return [];
      const { left, top, width, height } = element.getBoundingClientRect();
      return [{ panel, left, top, width, height }];
    });
  return {
    side: home?.getBoundingClientRect() ?? new DOMRect(),
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
  choose(name);
  arrange(moved(layout.value, name, { ...target, left, top }));
}
