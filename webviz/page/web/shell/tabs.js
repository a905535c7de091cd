// The tabs of the side: the panels of webviz, and additional ones, which come and go.

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { openMenu, openMenuBelow } from "webviz/controls/menu.js";
import * as docks from "webviz/docks/docks.js";
import { openIn } from "webviz/docks/frame.js";
import { openPanel } from "webviz/docks/layout.js";
import { el, set } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { added, panels, types } from "webviz/panels/panels.js";
import { recall, remember } from "webviz/remember.js";
import { computed, each, effect, owned, signal, untracked } from "webviz/signals.js";
import { provideFrom } from "webviz/shell/command_list.js";
import { chooseType } from "webviz/shell/gallery.js";

/** @import {PanelType} from "webviz/contents.js" */
/** @import {Readable, Signal} from "webviz/signals.js" */
/** @import {Panel} from "webviz/types.js" */

const FADED = 20; // pixels at the edge of a list that goes on, as in plugin_widgets.css

/**
 * The panels that are tabs, and the open one of these.
 *
 * @typedef {{
 *   tabs: Readable<Panel[]>, open: Readable<Panel | undefined>,
 *   choice: Signal<string>,
 * }} Panels
 */

/** Elements: the list of tabs, and the open one, a head above what it shows. */
export function tabs() {
  const model = follow();
  const { open } = model;
  const list = tabList(model);
  const add = iconButton("plus", "Add a panel", choose, {
    class: "wv-icon wv-tabs-add",
    hidden: () => !types.value.length,
  });
  const more = iconButton("chevron-down", "All panels", () => chooseTab(more, model, update), {
    class: "wv-icon wv-tabs-more",
    hidden: true,
    "aria-haspopup": "menu",
  });
  const update = fit(list, more, model);
  provideFrom([], commands);
  const bar = el("div", { class: "wv-tab-bar" }, list, more, needs("AddPanel", add));
  return [bar, ...contentOf(open)];
}

/** @returns {Panels} */
function follow() {
  // It may come later than the page, or again after a save.
  const choice = signal(recall("tab", ""));
  const tabs = computed(() => panels.value.filter((panel) => !docks.isPlaced(panel)));
  const open = computed(
    () => tabs.value.find(({ name }) => name === choice.value) ?? tabs.value[0],
  );
  effect(() => docks.offer(panels.value));
  /** @type {Set<string>} */
  let before = new Set();
  effect(() => {
    const fresh = added.value.find(({ name }) => !before.has(name));
    before = new Set(added.value.map(({ name }) => name));
    if (fresh) untracked(() => bring(fresh));
  });
  return { tabs, open, choice };

  /** @param {Panel} panel that this page has added, perhaps */
  function bring({ name }) {
    const { type } = adding;
    if (!type) return;
    adding.type = null;
    docks.bringForward(name);
    if (type.opens !== "below" || docks.isTabsOnly()) choice.value = name;
  }
}

/** The type of the panel that this page adds, which it then opens. */
const adding = { type: /** @type {PanelType | null} */ (null) };

/** @param {PanelType} type */
async function addPanel(type) {
  adding.type = type;
  const { level } = await act("AddPanel", { type: type.type, values: {} });
  if (level === "error") adding.type = null;
}

async function choose() {
  const type = await chooseType(types.value);
  if (type) addPanel(type);
}

/** @param {Panels} panels */
function tabList({ tabs, open, choice }) {
  /** @param {KeyboardEvent} event */
  function onkeydown(event) {
    const change = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!change) return;
    event.preventDefault(); // else the list is scrolled, too
    const buttons = /** @type {HTMLElement[]} */ ([...list.children]).filter(
      (each) => !each.hidden,
    );
    const next = buttons.indexOf(/** @type {HTMLElement} */ (document.activeElement)) + change;
    const button = buttons[(next + buttons.length) % buttons.length];
    button.focus();
    button.click();
  }
  /** @param {Signal<Panel>} panel @param {string} name */
  function tab(panel, name) {
    const isOpen = () => open.value?.name === name;
    const button = el(
      "button",
      {
        type: "button",
        role: "tab",
        id: `wv-tab-${name}`,
        "aria-controls": "wv-panel",
        "aria-selected": () => String(isOpen()),
        tabindex: () => (isOpen() ? 0 : -1),
        hidden: () => Boolean(panel.value.isOnDemand) && !isOpen(),
        onclick: () => remember("tab", (choice.value = name)),
        oncontextmenu: (/** @type {PointerEvent} */ event) => {
          event.preventDefault();
          openMenu(event.clientX, event.clientY, docks.menuOf(panel.value));
        },
      },
      () => panel.value.title,
    );
    docks.dragTab(button, () => name);
    return button;
  }
  const list = el(
    "div",
    { class: "wv-tabs", role: "tablist", "aria-label": "Panels", onkeydown },
    each(
      () => tabs.value,
      ({ name }) => name,
      tab,
    ),
  );
  // A wheel turns up and down only; tabs beyond the edge are at the side.
  list.addEventListener("wheel", ({ deltaY }) => (list.scrollLeft += deltaY), { passive: true });
  return list;
}

/**
 * Keeps the open tab in sight, and shows `more` while there are tabs out of sight; returns what does
 * so again, after the user has moved the list.
 *
 * @param {HTMLElement} list
 * @param {HTMLElement} more
 * @param {Panels} panels
 */
function fit(list, more, { tabs, open }) {
  function update() {
    set(more, { hidden: true });
    const isCut = list.scrollWidth > list.clientWidth;
    set(more, { hidden: !isCut });
    set(list, { "data-cut": isCut });
    const button = document.getElementById(`wv-tab-${open.value?.name}`);
    if (button) bringIntoSight(list, button);
  }
  effect(() => {
    for (const { title } of tabs.value) void title;
    void open.value;
    requestAnimationFrame(update);
  });
  new ResizeObserver(update).observe(/** @type {HTMLElement} */ (list));
  return update;
}

/**
 * Not `scrollIntoView`, which moves the whole page while the side is folded away.
 *
 * @param {HTMLElement} list
 * @param {HTMLElement} button
 */
function bringIntoSight(list, { offsetLeft, offsetWidth }) {
  const right = offsetLeft + offsetWidth + FADED - list.offsetLeft;
  if (right > list.scrollLeft + list.clientWidth) list.scrollLeft = right - list.clientWidth;
  list.scrollLeft = Math.min(list.scrollLeft, offsetLeft - list.offsetLeft);
}

/**
 * The head of the open tab, and what it shows.
 *
 * @param {Readable<Panel | undefined>} open
 */
function contentOf(open) {
  const tools = el("div", { class: "wv-panel-tools" });
  const content = el("div", { class: "wv-panel", role: "tabpanel", id: "wv-panel" });
  const more = iconButton("dots", "More for this panel", () => {
    if (open.value) openMenuBelow(more, docks.menuOf(open.value));
  });
  const head = el("div", { class: "wv-panel-head" }, tools, more);
  const name = computed(() => open.value?.name);
  effect(() => {
    tools.replaceChildren();
    content.replaceChildren();
    set(content, { "aria-labelledby": name.value ? `wv-tab-${name.value}` : null });
    const panel = untracked(() => open.value);
    set(head, { hidden: !panel?.remove });
    if (panel) owned(openIn(panel, content, tools));
  });
  return [head, content];
}

/**
 * @param {HTMLElement} button
 * @param {Panels} panels
 * @param {() => void} chosen
 */
function chooseTab(button, { tabs, open, choice }, chosen) {
  /** @param {string} name */
  function choose(name) {
    remember("tab", (choice.value = name));
    chosen();
  }
  openMenuBelow(
    button,
    tabs.value.map(({ name, title }) => ({
      label: title,
      checked: name === open.value?.name,
      run: () => choose(name),
    })),
  );
}

const commands = () => [
  ...panels.value
    .filter(({ isOnDemand }) => !isOnDemand)
    .map(({ name, title }) => ({
      name: `Panel: ${title}`,
      group: "Panels",
      run: () => openPanel(name),
    })),
  {
    name: "Add panel…",
    icon: "plus",
    group: "Panels",
    needs: "AddPanel",
    run: choose,
  },
  ...types.value.map((type) => ({
    name: `Add panel: ${type.title}`,
    icon: type.icon,
    group: "Panels",
    needs: "AddPanel",
    run: () => addPanel(type),
  })),
];
