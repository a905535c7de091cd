// The tree: global options, displays and groups, with what this browser has selected and folded.

import { el, showText } from "webviz/dom.js";
import { touchable } from "webviz/controls/rows.js";
import { VirtualList } from "webviz/controls/virtual.js";
import { effect, untracked } from "webviz/signals.js";
import { watch } from "webviz/stores.js";
import { recall, remember } from "webviz/remember.js";
import * as actions from "webviz/panels/displays/actions.js";
import { listenToDrags } from "webviz/panels/displays/drag.js";
import * as folding from "webviz/panels/displays/folding.js";
import { listenToKeys } from "webviz/panels/displays/keys.js";
import {
  GLOBAL,
  arrange,
  editable,
  globalItem,
  matches,
  placeAmong,
  visible,
} from "webviz/panels/displays/model.js";
import { HOVER_MS, listenToPointer } from "webviz/panels/displays/pointer.js";
import { rename } from "webviz/panels/displays/rename.js";
import { makeRow } from "webviz/panels/displays/row.js";
import * as selection from "webviz/panels/displays/selection.js";
import { wordsOf } from "webviz/words.js";

/** @import {Item, Model, Tree} from "webviz/panels/displays/types.js" */

const SCROLL_KEY = "displays.scroll";
const EMPTY = "No displays yet. Add one for a topic, the robot or a grid.";
const NOT_FOUND = "No matching displays.";
const BEYOND_PX = 300; // above and below what is seen
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
  /** @type {Tree["list"]} */
  const list = new VirtualList({
    scroller: element,
    canvas,
    keyOf: ({ id }) => id,
    guess,
    make: (item, _, id) => makeRow(id, item, look),
    held: selection.active,
    beyond: () => BEYOND_PX,
  });

  const all = () => [global, ...model.items];

  /** @param {Item} item */
  function guess(item) {
    const status = item.line && item.isActive ? GUESS.status : 0;
    return rowHeight() + status + (folding.isOpen(item) && !item.isGroup ? GUESS.inside : 0);
  }

  /** @param {Item} item */
  function look(item) {
    const isAlone = selection.ids().size === 1 && selection.isSelected(item.id);
    return {
      isOpen: search && item.isGroup ? true : folding.isOpen(item),
      isSelected: selection.isSelected(item.id),
      isTabStop: item.id === selection.active(),
      enabled: actions.isEnabled(item),
      hasRate: item.isActive && (isAlone || item.id === pointer.hovered()),
      ...placeAmong(model, item),
    };
  }

  function refresh() {
    const isGlobalShown = matches(global, wordsOf(search));
    rows = [...(isGlobalShown ? [global] : []), ...visible(model, folding.isOpen, search)];
    if (!rows.some(({ id }) => id === selection.active())) {
      selection.activate(
        rows.find(({ id }) => selection.isSelected(id))?.id ?? rows[0]?.id ?? null,
      );
    }
    list.show(rows);
    const sentence = !model.items.length ? (isKnown ? EMPTY : "") : rows.length ? "" : NOT_FOUND;
    showText(none, sentence);
    changed({ items: editable(all(), selection.isSelected), search });
    selection.save(all());
  }

  function update() {
    const items = all();
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
    focus,
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
      ends.forEach((end) => end());
      list.close();
    },
  };

  let scrolled = 0;
  element.addEventListener("scroll", () => {
    clearTimeout(scrolled);
    scrolled = setTimeout(() => remember(SCROLL_KEY, Math.round(element.scrollTop)), HOVER_MS);
  });
  const pointer = listenToPointer(canvas, tree);
  listenToKeys(canvas, tree);
  const ends = [
    effect(() => {
      if (selection.added() && isKnown) untracked(update);
    }),
    pointer.end,
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
