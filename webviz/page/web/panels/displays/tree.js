// The tree: global options, displays and groups, with what this browser has selected and folded.

import { el, set, setText } from "../../dom.js";
import { touchable } from "../../controls/rows.js";
import { watch } from "../../stores.js";
import { recall, remember } from "../../remember.js";
import * as actions from "./actions.js";
import { listenToDrags } from "./drag.js";
import * as folding from "./folding.js";
import { listenToKeys } from "./keys.js";
import { GLOBAL, arrange, globalItem, matches, siblings, visible } from "./model.js";
import { rename } from "./rename.js";
import { makeRow } from "./row.js";
import * as selection from "./selection.js";
import { virtualList } from "./virtual.js";
import { wordsOf } from "../../words.js";

/** @import {Item, Model, Tree} from "./types.js" */

const SCROLL_KEY = "displays.scroll";
const HOVER_MS = 250;
const SEEN_MS = 400; // a second click must find the row where the first one did
const EMPTY = "No displays yet. Add one for a topic, the robot or a grid.";
const NOT_FOUND = "No matching displays.";
const GUESS = { status: 18, inside: 240 };

/**
 * Builds the tree; `after` follows the last row. `changed({items, search})` is called when
 * something else is shown or selected: `items` are those whose properties are shown, and `search` what
 * is searched for, which ends when something else is added.
 *
 * @param {{after: HTMLElement, changed: (shown: {items: Item[], search: string}) => void}} options
 */
export function buildTree({ after, changed }) {
  let model = arrange(new Map());
  let global = globalItem(null);
  let search = "";
  /** @type {Item[]} */
  let rows = [];
  /** @type {string | null} */
  let hovered = null;
  let timer = 0;
  let isThere = false;
  let isKnown = false; // whether the viewer has said which displays there are
  /** @type {string | null} */
  let toRename = null;
  const canvas = el("div", {
    class: "wv-tree-canvas",
    role: "tree",
    "aria-label": "Displays",
    "aria-multiselectable": "true",
  });
  const none = el("p", { class: "wv-tree-none", hidden: true });
  const element = el("div", { class: "wv-tree" }, canvas, none, after);
  const list = virtualList({
    scroller: element,
    canvas,
    guess,
    make: (/** @type {Item} */ item) => makeRow(item, look),
    isHeld: (/** @type {string} */ id) => id === selection.active(),
  });

  /** @param {Item} item */
  function guess(item) {
    const status = item.line && item.isActive ? GUESS.status : 0;
    return rowHeight() + status + (folding.isOpen(item) && !item.isGroup ? GUESS.inside : 0);
  }

  /** @param {Item} item */
  function look(item) {
    const among = siblings(model, item);
    const above = item.parent ? 0 : 1; // the global options
    const isAlone = selection.ids().size === 1 && selection.isSelected(item.id);
    return {
      isOpen: search && item.isGroup ? true : folding.isOpen(item),
      isSelected: selection.isSelected(item.id),
      isTabStop: item.id === selection.active(),
      enabled: actions.isEnabled(item),
      hasRate: item.isActive && (isAlone || item.id === hovered),
      position: item.id === GLOBAL ? 1 : among.indexOf(item) + 1 + above,
      count: among.length + above,
    };
  }

  function refresh() {
    const words = wordsOf(search);
    const isGlobalShown = !words.length || matches(global, words);
    rows = [...(isGlobalShown ? [global] : []), ...visible(model, folding.isOpen, search)];
    if (!rows.some(({ id }) => id === selection.active())) {
      selection.activate(
        rows.find(({ id }) => selection.isSelected(id))?.id ?? rows[0]?.id ?? null,
      );
    }
    list.show(rows);
    const sentence = !model.items.length ? (isKnown ? EMPTY : "") : rows.length ? "" : NOT_FOUND;
    setText(none, sentence);
    set(none, { hidden: sentence === "" });
    changed({ items: editable(), search });
    selection.save([global, ...model.items]);
  }

  // What is selected alone, or else the displays that can be edited together.
  function editable() {
    const chosen = [global, ...model.items].filter(({ id }) => selection.isSelected(id));
    return chosen.length > 1 ? chosen.filter((item) => item.can_edit && !item.isGroup) : chosen;
  }

  function update() {
    const items = [global, ...model.items];
    const hadFocus = canvas.contains(document.activeElement);
    const before = selection.active();
    folding.follow(items);
    const added = selection.follow(items);
    const item = added && model.byId.get(added);
    if (item) {
      if (!matches(item, wordsOf(search))) search = "";
      for (let { parent } = item; parent; { parent } = parent) folding.setOpen(parent, true);
    }
    refresh();
    if (added) list.reveal(added);
    else if (!isThere && model.items.length) element.scrollTop = recall(SCROLL_KEY, 0);
    isThere ||= model.items.length > 0;
    if (hadFocus && (selection.active() !== before || !canvas.contains(document.activeElement)))
      focus();
    if (toRename && model.byId.has(toRename)) startRename(toRename);
  }

  function focus() {
    list.row(selection.active())?.row.focus({ preventScroll: true });
  }

  function showActive() {
    refresh();
    list.reveal(selection.active());
    focus();
  }

  /** @param {string | null} id */
  function startRename(id) {
    const item = id === null ? undefined : model.byId.get(id);
    toRename = item ? null : id; // when it is there
    if (!item?.can_edit) return;
    list.reveal(item.id);
    const row = list.row(item.id);
    if (row) rename(row, item);
  }

  /** @type {Tree} */
  const tree = {
    element,
    canvas,
    list,
    model: () => model,
    rows: () => rows,
    refresh,
    showActive,
    rename: startRename,
    itemAt: (target) => {
      if (!(target instanceof Element)) return null;
      const id = target.closest(".wv-tree-node")?.getAttribute("data-id");
      if (!id || target.closest(".wv-tree-inside, .wv-tree-rename")) return null;
      return rows.find((row) => row.id === id) ?? null;
    },
    setOpen(item, open) {
      folding.setOpen(item, open);
      refresh();
    },
    setSearch(text) {
      if (text === search) return;
      search = text;
      element.scrollTop = 0;
      refresh();
    },
    openMenu(id, x, y) {
      if (id === GLOBAL) return;
      if (!selection.isSelected(id)) selection.choose(id);
      refresh();
      focus();
      const row = list.row(id)?.row;
      if (!row) return; // somebody removed it meanwhile
      const { left, bottom } = row.getBoundingClientRect();
      const shared = { model, rows: tree.rows, rename: startRename, refresh };
      actions.openActions(x ?? left + 40, y ?? bottom, shared);
    },
    close() {
      clearTimeout(timer);
      ends.forEach((end) => end());
      list.close();
    },
  };

  /** @param {PointerEvent} event */
  function onClick(event) {
    const item = tree.itemAt(event.target);
    const target = /** @type {Element} */ (event.target);
    const part = target.closest("[data-part]")?.getAttribute("data-part");
    if (!item || part === "box" || part === "remedy") return;
    if (part === "fold") {
      selection.activate(item.id);
      tree.setOpen(item, !folding.isOpen(item));
      return focus();
    }
    if (part === "more") return tree.openMenu(item.id, event.clientX, event.clientY);
    if (event.detail > 1) return;
    if (event.shiftKey) selection.extend(item.id, rows);
    else if (event.ctrlKey || event.metaKey || selection.severalAtOnce()) selection.toggle(item.id);
    else selection.choose(item.id);
    refresh();
    focus();
    setTimeout(() => item.id === selection.active() && list.reveal(item.id), SEEN_MS);
  }

  /** @param {PointerEvent} event */
  function onHover(event) {
    const name = /** @type {Element} */ (event.target).closest(".wv-tree-name");
    if (name)
      set(name, { "data-tip": name.scrollWidth > name.clientWidth ? name.textContent : null });
    clearTimeout(timer);
    const id = event.pointerType === "mouse" ? (tree.itemAt(event.target)?.id ?? null) : null;
    if (id === hovered) return;
    timer = setTimeout(() => {
      hovered = id;
      refresh();
    }, HOVER_MS);
  }

  set(canvas, {
    onclick: onClick,
    ondblclick: (event) => {
      const item = tree.itemAt(event.target);
      if (item && !event.target.closest("[data-part]")) startRename(item.id);
    },
    onchange: ({ target }) => {
      const item = target.dataset.part === "box" && tree.itemAt(target);
      if (!item) return;
      selection.activate(item.id);
      actions.setEnabled([item], target.checked, refresh);
      focus();
    },
    oncontextmenu: (event) => {
      const item = tree.itemAt(event.target);
      if (!item) return;
      event.preventDefault();
      if (event.pointerType !== "touch") tree.openMenu(item.id, event.clientX, event.clientY);
    },
    onpointerover: onHover,
    onpointerleave: onHover,
    onfocusin: ({ target }) => {
      const item = target.getAttribute("role") === "treeitem" && tree.itemAt(target);
      if (item && item.id !== selection.active()) {
        selection.activate(item.id);
        refresh();
      }
    },
  });
  let scrolled = 0;
  element.addEventListener("scroll", () => {
    clearTimeout(scrolled);
    scrolled = setTimeout(() => remember(SCROLL_KEY, Math.round(element.scrollTop)), HOVER_MS);
  });
  listenToKeys(canvas, tree);
  selection.onAdded(update);
  const ends = [
    () => selection.onAdded(() => {}),
    listenToDrags(canvas, tree),
    watch("settings", (settings) => {
      global = globalItem(settings);
      refresh(); // which displays there are is not known yet after a lost connection
    }),
    watch("displays", (values) => {
      model = arrange(values);
      isKnown = values.has("order");
      update();
    }),
  ];
  return tree;
}

const rowHeight = () => touchable(26);
