// The toolbar over the scene: the tools, what this page looks at, and what everything is drawn in.

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { combobox } from "webviz/controls/combobox.js";
import { frameOptions } from "webviz/controls/frame.js";
import { el } from "webviz/dom.js";
import { icon, iconButton } from "webviz/icons.js";
import { ownStore } from "webviz/own_store.js";
import { each, effect, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { actions, item } from "webviz/shell/actions.js";
import { command } from "webviz/commands.js";
import { FIXED, follow } from "webviz/shell/follow.js";
import { fold } from "webviz/docks/layout.js";
import { openMenuBelow } from "webviz/controls/menu.js";
import { fit } from "webviz/shell/overflow.js";
import * as tools from "webviz/shell/tool_buttons.js";
import { VIEW_TYPES, setType, typeMenu } from "webviz/shell/view_menus.js";

/** @import {Readable} from "webviz/signals.js" */
/** @import {Child, Choice} from "webviz/types.js" */
/** @import {MenuItem} from "webviz/controls/menu.js" */

/** @typedef {{icon: string, label: string, items: () => (MenuItem | null)[]}} BarMenu */

const settings = store("settings");
const fixedFrame = () => settings.get("fixed_frame") ?? "";
/** @type {Choice[]} */
const NO_TARGET = [{ value: FIXED, label: "No target" }];

const menus = signal(/** @type {BarMenu[]} */ ([]));

/**
 * Adds a menu of a feature to the toolbar.
 *
 * @param {string} icon
 * @param {string} label
 * @param {() => (MenuItem | null)[]} items its entries, whenever it opens
 */
export function barMenu(icon, label, items) {
  menus.value = [...menus.value, { icon, label, items }];
}

const menuButtons = () =>
  each(
    () => menus.value,
    (menu) => menu.label,
    (menu) => menuButton(menu.value),
  );

/** @param {BarMenu} menu */
function menuButton({ icon, label, items }) {
  const name = el("span", { class: "wv-bar-name" }, label);
  const element = button(icon, label, () => openMenuBelow(element, items()), name);
  return element;
}

/** @param {{toolbar: HTMLElement, status: HTMLElement}} places */
export function install(places) {
  tools.install();
  const view = viewOfPage();
  const open = iconButton("menu", "Show the panels", () => fold(false), {
    class: "wv-icon wv-unfold",
    "data-key": "Ctrl+b",
  });
  const type = typeButton(view.type);
  const ofFeatures = el("span", { class: "wv-bar-part" }, menuButtons());
  const setFixed = (/** @type {string} */ frame) => act("SetFixedFrame", { frame });
  const fixed = frameField("Fixed frame", "axes", fixedFrame, frameOptions, setFixed);
  const targets = () => [...NO_TARGET, ...frameOptions()];
  const target = frameField("Follow", "follow", () => view.target.value, targets, follow);
  const image = button("camera", actions.image.name, actions.image.run);
  const full = button("fullscreen", actions.fullscreen.name, actions.fullscreen.run);
  const more = button("dots", "More", () => openMenuBelow(more, bar.hiddenItems()));
  const parts = [type, ofFeatures, needs("SetFixedFrame", fixed), target, image, full, more];
  const element = el(
    "div",
    {
      class: tools.isNew() ? "wv-toolbar wv-card wv-worded" : "wv-toolbar wv-card",
      role: "toolbar",
      "aria-label": "Tools and view",
      onkeydown: walk,
    },
    el("div", { class: "wv-bar-part" }, open, tools.icons, tools.buttons),
    el("span", { class: "wv-bar-line", hidden: () => !tools.hasButtons() }),
    el("div", { class: "wv-bar-part wv-bar-view" }, parts),
  );
  // The frames and the tools that act on the robot stay, however little room the scene has.
  /** @type {ReturnType<typeof fit>} */
  const bar = fit(element, more, [
    "wv-compact",
    "wv-tight",
    "wv-two-rows",
    "wv-wordless",
    { element: full, items: () => [item(actions.fullscreen)] },
    { element: image, items: () => [item(actions.image)] },
    "wv-wrapped",
    { element: tools.icons, items: () => tools.iconItems() },
    { element: ofFeatures, items: () => menus.value.flatMap(({ items }) => items()) },
    { element: type, items: () => typeMenu(view.type.value) },
    "wv-stacked",
  ]);
  places.toolbar.append(element, tools.cards, tools.hint);
  bar.watch(places.toolbar);
  measure(places.status, places.toolbar, "--wv-status", "offsetWidth"); // it keeps its space
  measure(element, document.documentElement, "--wv-bar", "offsetHeight"); // below in a narrow scene
  effect(() => {
    if (tools.all() && menus.value && view.type.value !== null) bar.layout();
  });
  addCommands(fixed, target);
}

/** @param {Readable<string>} label */
function typeButton(label) {
  const name = el("span", { class: "wv-bar-name" }, label);
  const element = button("orbit", "", () => openMenuBelow(element, typeMenu(label.value)), name);
  effect(() => {
    element.ariaLabel = `View: ${label.value}`;
    element.dataset.tip = `View type: ${label.value}`;
  });
  return element;
}

/** Signals: the type of the view of this page and the frame it follows, the last that were known. */
function viewOfPage() {
  const view = ownStore("view_type");
  const [type, target] = [signal(""), signal(FIXED)];
  effect(() => {
    type.value = view.get("type") ?? type.value;
    target.value = view.get("target_frame") ?? target.value;
  });
  return { type, target };
}

/**
 * Keeps a size of an element in a property of styles.
 *
 * @param {HTMLElement} measured
 * @param {HTMLElement} place
 * @param {string} property
 * @param {"offsetWidth" | "offsetHeight"} size
 */
const measure = (measured, place, property, size) =>
  new ResizeObserver(() => place.style.setProperty(property, `${measured[size]}px`)).observe(
    measured,
  );

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
  for (const name of VIEW_TYPES) {
    command({ name: `View: ${name}`, icon: "orbit", group: "View", run: () => setType(name) });
  }
}

/**
 * @param {string} iconName
 * @param {string} tip
 * @param {() => unknown} run
 * @param {Child} [name]
 */
function button(iconName, tip, run, name) {
  const element = iconButton(iconName, tip, run, { class: "wv-icon wv-bar-button" });
  if (name) element.append(name);
  return element;
}

/**
 * @param {string} label
 * @param {string} iconName
 * @param {() => string} value
 * @param {() => Choice[]} options
 * @param {(frame: string) => unknown} change
 */
function frameField(label, iconName, value, options, change) {
  /** @type {ReturnType<typeof combobox>} */
  const field = combobox({
    label,
    value,
    options,
    change,
    refused: (text) => text && field.restore(),
  });
  return el("div", { class: "wv-bar-field", "data-tip": label }, icon(iconName), field.element);
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
