// The tabs of the side: the panels of webviz, and additional ones, which come and go.

import { needs } from "../access.js";
import { act } from "../act.js";
import * as docks from "../docks/docks.js";
import { openIn } from "../docks/frame.js";
import { el, set, setChildren, setText } from "../dom.js";
import { onPanel, panels } from "../panels/panels.js";
import { followPlugins } from "../panels/plugin.js";
import { iconButton } from "../icons.js";
import { recall, remember } from "../remember.js";
import { provideFrom } from "./command_list.js";
import { openPanel } from "../docks/layout.js";
import { openMenu, openMenuBelow } from "../controls/menu.js";

/** @import {PanelType} from "../contents.js" */
/** @import {Panel} from "../types.js" */

/** Elements: the list of tabs, and what the open one shows. */
export function tabs() {
  const content = el("div", { class: "wv-panel", role: "tabpanel", id: "wv-panel" });
  const list = el("div", { class: "wv-tabs", role: "tablist", "aria-label": "Panels" });
  /** @type {Map<string, HTMLButtonElement>} */
  const buttons = new Map();
  const add = iconButton("plus", "Add a panel", chooseType, {
    class: "wv-icon wv-tabs-add",
    hidden: true,
  });
  needs("AddPanel", add);
  const more = iconButton("chevron-down", "All panels", chooseTab, {
    class: "wv-icon wv-tabs-more",
    hidden: true,
    "aria-haspopup": "menu",
  });
  new ResizeObserver(fit).observe(list);
  /** @type {PanelType[]} */
  let types = [];
  const own = new Set(panels);
  let all = [...panels];
  /** @type {Panel[]} */
  let additional = [];
  /** @type {Panel | null} */
  let shown = null;
  let isAdding = false; // by this page, which then opens the panel
  /** @type {() => void} */
  let close = () => {};

  list.addEventListener("keydown", (event) => {
    const change = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!change) return;
    event.preventDefault(); // else the list is scrolled, too
    const seen = /** @type {HTMLElement[]} */ ([...list.children]).filter((each) => !each.hidden);
    const next = seen.indexOf(/** @type {HTMLElement} */ (document.activeElement)) + change;
    const button = seen[(next + seen.length) % seen.length];
    button.focus();
    button.click();
  });

  // A wheel turns up and down only; tabs beyond the edge are at the side.
  list.addEventListener("wheel", ({ deltaY }) => (list.scrollLeft += deltaY), { passive: true });

  /** @param {Panel} panel */
  function button(panel) {
    const { name } = panel;
    const id = `wv-tab-${name}`;
    const made = el("button", {
      type: "button",
      role: "tab",
      id,
      "aria-controls": "wv-panel",
      onclick: () => {
        const panel = all.find((one) => one.name === name);
        if (panel) show(panel);
      },
      oncontextmenu: (/** @type {PointerEvent} */ event) => {
        event.preventDefault();
        openMenu(event.clientX, event.clientY, docks.menuOf(panel));
      },
    });
    docks.dragTab(made, panel);
    return made;
  }

  /** @param {Panel} [panel] none if all stand outside of the tabs */
  function show(panel) {
    close();
    close = () => {};
    content.replaceChildren();
    shown = panel ?? null;
    mark();
    fit();
    if (!panel) return;
    set(content, { "aria-labelledby": `wv-tab-${panel.name}` });
    remember("tab", panel.name);
    close = openIn(panel, content);
  }

  /**
   * Not `scrollIntoView`, which moves the whole page while the side is folded away.
   *
   * @param {HTMLElement} button
   */
  function bringIntoSight({ offsetLeft, offsetWidth }) {
    const right = offsetLeft + offsetWidth - list.offsetLeft;
    if (right > list.scrollLeft + list.clientWidth) list.scrollLeft = right - list.clientWidth;
    list.scrollLeft = Math.min(list.scrollLeft, offsetLeft - list.offsetLeft);
  }

  // One button at a time, since both take space; the menu adds panels, too.
  function fit() {
    const isFull = list.scrollWidth > list.clientWidth;
    more.hidden = !isFull;
    set(add, { hidden: isFull || !types.length });
    const button = shown && buttons.get(shown.name);
    if (button) bringIntoSight(button);
  }

  function mark() {
    for (const [name, each] of buttons) {
      const isShown = name === shown?.name;
      const panel = all.find((one) => one.name === name);
      set(each, { hidden: Boolean(panel?.isOnDemand) && !isShown });
      set(each, { "aria-selected": String(isShown), tabindex: isShown ? 0 : -1 });
    }
  }

  /**
   * @param {Panel[]} plugins
   * @returns {void}
   */
  function offer(plugins) {
    additional = plugins;
    const wanted = recall("tab", "");
    const there = [...panels, ...plugins];
    docks.offer(there);
    all = there.filter((panel) => !docks.isPlaced(panel));
    const come = isAdding && all.find((panel) => !own.has(panel) && !buttons.has(panel.name));
    for (const panel of all) {
      const known = buttons.get(panel.name) ?? button(panel);
      buttons.set(panel.name, known);
      setText(known, panel.title);
    }
    for (const name of buttons.keys())
      if (!all.some((panel) => panel.name === name)) buttons.delete(name);
    setChildren(
      list,
      all.flatMap(({ name }) => buttons.get(name) ?? []),
    );
    mark();
    fit();
    if (come) {
      isAdding = false;
      return show(come);
    }
    const isGone = !all.some(({ name }) => name === shown?.name);
    // The tab of a plug-in that was open comes after the page.
    const isWaited = all
      .filter((panel) => !own.has(panel))
      .find(({ name }) => name === wanted && name !== shown?.name);
    if (isGone || isWaited) show(isWaited ?? all.find(({ name }) => name === wanted) ?? all[0]);
    if (isGone && wanted) remember("tab", wanted); // it may come again, after a save
  }

  function chooseType() {
    const { left, bottom } = add.getBoundingClientRect();
    openMenu(left, bottom, ofTypes());
  }

  const ofTypes = () =>
    types.map(({ type, title }) => ({ label: title, run: () => addPanel(type) }));

  /** @param {string} type */
  async function addPanel(type) {
    isAdding = true;
    const { level } = await act("AddPanel", { type, values: {} });
    if (level === "error") isAdding = false;
  }

  function chooseTab() {
    const adding = { label: "Add a panel", icon: "plus", needs: "AddPanel", items: ofTypes() };
    openMenuBelow(more, [
      ...all.map((panel) => ({
        label: panel.title,
        checked: panel.name === shown?.name,
        run: () => show(panel),
      })),
      ...(types.length ? [null, adding] : []),
    ]);
  }

  provideFrom([], () => [
    ...[...panels, ...additional]
      .filter(({ isOnDemand }) => !isOnDemand)
      .map(({ name, title }) => ({
        name: `Panel: ${title}`,
        group: "Panels",
        run: () => openPanel(name),
      })),
    ...types.map(({ type, title }) => ({
      name: `Add panel: ${title}`,
      icon: "plus",
      group: "Panels",
      needs: "AddPanel",
      run: () => addPanel(type),
    })),
  ]);
  offer([]);
  onPanel(() => offer(additional));
  docks.onPlaced(() => offer(additional));
  followPlugins(offer, (known) => {
    types = known;
    fit();
  });
  return [el("div", { class: "wv-tab-bar" }, list, more, add), content];
}
