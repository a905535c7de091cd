// The toolbar over the scene: the tools, what this page looks at, and what everything is drawn in.

import { needs } from "../access.js";
import { act } from "../act.js";
import * as channel from "../channel.js";
import { combobox } from "../controls/combobox.js";
import { el, set, setText } from "../dom.js";
import { icon, iconButton } from "../icons.js";
import { watch } from "../stores.js";
import { actions, item } from "./actions.js";
import { command } from "./commands.js";
import { FIXED, follow } from "./follow.js";
import { fold } from "./layout.js";
import { openMenuBelow } from "./menu.js";
import { fit } from "./overflow.js";
import * as tools from "./tools.js";
import { VIEW_TYPES, savedMenu, saveView, setType, typeMenu } from "./view_menus.js";

/** @import {Choice} from "../types.js" */

/** @type {{type: string, target: string, frame: string, frames: string[], views: string[]}} */
const shown = { type: "", target: FIXED, frame: "", frames: [], views: [] };

/** @param {{toolbar: HTMLElement, status: HTMLElement}} places */
export function install(places) {
  tools.install();
  const open = iconButton("menu", "Show the panels", () => fold(false), {
    class: "wv-icon wv-unfold",
    "data-key": "Ctrl+b",
  });
  const type = button("orbit", "", "View", () => openMenuBelow(type, typeMenu(shown.type)));
  const views = button("bookmark", "Saved views", "Saved views", () =>
    openMenuBelow(views, savedMenu(saved)),
  );
  const fixed = frameField("Fixed frame", "axes", () => shown.frame, fixedOptions, setFixed);
  needs("SetFixedFrame", fixed.element);
  const target = frameField("Follow", "follow", () => shown.target, targetOptions, follow);
  const image = button("camera", null, actions.image.name, actions.image.run);
  const full = button("fullscreen", null, actions.fullscreen.name, actions.fullscreen.run);
  const more = button("dots", null, "More", () => openMenuBelow(more, bar.hiddenItems()));
  const line = el("span", { class: "wv-bar-line" });
  const element = el(
    "div",
    {
      class: "wv-toolbar wv-card",
      role: "toolbar",
      "aria-label": "Tools and view",
      onkeydown: walk,
    },
    el("div", { class: "wv-bar-part" }, open, tools.icons, tools.buttons),
    line,
    el(
      "div",
      { class: "wv-bar-part wv-bar-view" },
      type,
      views,
      fixed.element,
      target.element,
      image,
      full,
      more,
    ),
  );
  // The frames and the tools that act on the robot stay, however little room the scene has.
  /** @type {ReturnType<typeof fit>} */
  const bar = fit(element, more, [
    "wv-compact",
    "wv-tight",
    { element: full, items: () => [item(actions.fullscreen)] },
    { element: image, items: () => [item(actions.image)] },
    "wv-wrapped",
    { element: tools.icons, items: () => tools.iconItems() },
    { element: views, items: () => savedMenu(saved) },
    { element: type, items: () => typeMenu(shown.type) },
    "wv-stacked",
  ]);
  places.toolbar.append(element, tools.cards, tools.hint);
  bar.watch(places.toolbar);
  // What stands at the right keeps its space.
  new ResizeObserver(() => {
    places.toolbar.style.setProperty("--wv-status", `${places.status.offsetWidth}px`);
  }).observe(places.status);
  // In a narrow scene it stands below.
  new ResizeObserver(() => {
    document.documentElement.style.setProperty("--wv-bar", `${element.offsetHeight}px`);
  }).observe(element);

  const update = () => {
    const name = type.querySelector(".wv-bar-name");
    if (name) setText(name, shown.type);
    set(type, { "aria-label": `View: ${shown.type}`, "data-tip": `View type: ${shown.type}` });
    line.hidden = !tools.buttons.children.length;
    fixed.update();
    target.update();
    bar.layout();
  };
  tools.onTools(update);
  watch("settings", (settings) => {
    shown.frame = settings.get("fixed_frame") ?? "";
    shown.views = settings.get("views") ?? [];
    update();
  });
  watch("frames", (frames) => {
    shown.frames = frames.get("frames") ?? [];
    update();
  });
  watchView(update);
  addCommands(fixed.element, target.element);
}

/**
 * @param {HTMLElement} fixed
 * @param {HTMLElement} target
 */
function addCommands(fixed, target) {
  command({
    name: "Zero view",
    icon: "reset",
    key: "z",
    group: "View",
    run: () => act("ResetView"),
  });
  command({
    name: "Follow frame…",
    icon: "follow",
    group: "View",
    run: () => focusField(target),
  });
  command({
    name: "Fixed frame…",
    icon: "axes",
    group: "View",
    needs: "SetFixedFrame",
    run: () => focusField(fixed),
  });
  command({
    name: "Save view…",
    icon: "save",
    group: "View",
    needs: "SaveView",
    run: () => saveView(saved),
  });
  for (const name of VIEW_TYPES) {
    command({ name: `View: ${name}`, icon: "orbit", group: "View", run: () => setType(name) });
  }
}

/**
 * viser gives the page another id when it connects again.
 *
 * @param {() => void} update
 */
function watchView(update) {
  /** @type {() => void} */
  let end = () => {};
  const begin = () => {
    end();
    end = watch(`view_type:${window.webviz.browser}`, (view) => {
      shown.type = view.get("type") ?? shown.type;
      shown.target = view.get("target_frame") ?? shown.target;
      update();
    });
  };
  channel.onOpen(begin);
  if (channel.isOpen()) begin();
}

const saved = () => shown.views;
/** @param {string} frame */
const setFixed = (frame) => act("SetFixedFrame", { frame });
/** @returns {Choice[]} */
const fixedOptions = () => shown.frames.map((value) => ({ value }));
/** @returns {Choice[]} */
const targetOptions = () => [
  { value: FIXED, label: "No target" },
  ...shown.frames.map((value) => ({ value })),
];

/**
 * @param {string} iconName
 * @param {string | null} label
 * @param {string} tip
 * @param {() => unknown} run
 */
function button(iconName, label, tip, run) {
  const made = iconButton(iconName, tip, run, { class: "wv-icon wv-bar-button" });
  if (label !== null) made.append(el("span", { class: "wv-bar-name" }, label));
  return made;
}

/**
 * @param {string} label
 * @param {string} iconName
 * @param {() => string} value
 * @param {() => Choice[]} options
 * @param {(frame: string) => unknown} change
 */
function frameField(label, iconName, value, options, change) {
  const field = combobox({
    label,
    value: value(),
    options: options(),
    change,
    refused: (text) => text && field.restore(),
  });
  return {
    element: el("div", { class: "wv-bar-field", "data-tip": label }, icon(iconName), field.element),
    update: () => field.update({ value: value(), options: options() }),
  };
}

/** @param {HTMLElement} field */
const focusField = (field) => field.querySelector("input")?.focus();

/**
 * Arrow keys go from button to button; a field keeps them.
 *
 * @param {KeyboardEvent} event
 */
function walk(event) {
  const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
  const [bar, from] = /** @type {HTMLElement[]} */ ([event.currentTarget, event.target]);
  if (!step || from.matches("input")) return;
  event.preventDefault();
  event.stopPropagation();
  /** @type {NodeListOf<HTMLElement>} */
  const parts = bar.querySelectorAll("button, input");
  const all = [...parts].filter((one) => one.offsetParent);
  all.at((all.indexOf(from) + step) % all.length)?.focus();
}
