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
 * The tree; `after` follows the last row. `changed({items, search})` is called when
 * something else is shown or selected: `items` are those whose properties are shown, and `search` what
 * is searched for, which ends when something else is added.
 *
 * @implements {Tree}
 */
export class DisplayTree {
  #model = arrange(new Map());
  #global = globalItem(null);
  #search = "";
  /** @type {Item[]} */
  #rows = [];
  #isThere = false;
  #isKnown = false; // whether the viewer has said which displays there are
  /** @type {string | null} */
  #toRename = null;
  #none = el("p", { class: "wv-tree-none", hidden: true });
  #changed;
  #pointer;
  #ends;

  /** @param {{after: HTMLElement, changed: (shown: {items: Item[], search: string}) => void}} options */
  constructor({ after, changed }) {
    this.#changed = changed;
    this.canvas = el("div", {
      class: "wv-tree-canvas",
      role: "tree",
      "aria-label": "Displays",
      "aria-multiselectable": "true",
    });
    this.element = el("div", { class: "wv-tree" }, this.canvas, this.#none, after);
    /** @type {Tree["list"]} */
    this.list = new VirtualList({
      scroller: this.element,
      canvas: this.canvas,
      keyOf: ({ id }) => id,
      guess,
      make: (item, _, id) => makeRow(id, item, (now) => this.#look(now)),
      activeKey: selection.active,
      beyond: () => BEYOND_PX,
    });
    rememberScroll(this.element);
    this.#pointer = listenToPointer(this.canvas, this);
    listenToKeys(this.canvas, this);
    this.#ends = [
      effect(() => {
        if (selection.added() && this.#isKnown) untracked(() => this.#update());
      }),
      this.#pointer.end,
      listenToDrags(this.canvas, this),
      watch("settings", (settings) => {
        this.#global = globalItem(settings);
        this.refresh(); // which displays there are is not known yet after a lost connection
      }),
      watch("displays", (values) => {
        this.#model = arrange(values);
        this.#isKnown = values.has("order");
        this.#update();
      }),
    ];
  }

  model() {
    return this.#model;
  }

  rows() {
    return this.#rows;
  }

  refresh() {
    const model = this.#model;
    const isGlobalShown = matches(this.#global, wordsOf(this.#search));
    const rows = [
      ...(isGlobalShown ? [this.#global] : []),
      ...visible(model, folding.isOpen, this.#search),
    ];
    this.#rows = rows;
    if (!rows.some(({ id }) => id === selection.active())) {
      selection.activate(
        rows.find(({ id }) => selection.isSelected(id))?.id ?? rows[0]?.id ?? null,
      );
    }
    this.list.show(rows);
    const empty = this.#isKnown ? EMPTY : "";
    showText(this.#none, !model.items.length ? empty : rows.length ? "" : NOT_FOUND);
    const items = editable(this.#all(), selection.isSelected);
    this.#changed({ items, search: this.#search });
    selection.save(this.#all());
  }

  focus() {
    this.list.row(selection.active())?.row.focus({ preventScroll: true });
  }

  showActive() {
    this.refresh();
    this.list.reveal(selection.active());
    this.focus();
  }

  /** @param {string | null} id */
  rename(id) {
    const item = id === null ? undefined : this.#model.byId.get(id);
    this.#toRename = item ? null : id; // when it is there
    if (!item?.can_edit) return;
    this.list.reveal(item.id);
    const row = this.list.row(item.id);
    if (row) rename(row, item);
  }

  /** @param {EventTarget | null} target */
  itemAt(target) {
    if (!(target instanceof Element)) return null;
    const id = target.closest(".wv-tree-node")?.getAttribute("data-id");
    if (!id || target.closest(".wv-tree-inside, .wv-tree-rename")) return null;
    return this.#rows.find((row) => row.id === id) ?? null;
  }

  /**
   * @param {Item} item
   * @param {boolean} open
   */
  setOpen(item, open) {
    folding.setOpen(item, open);
    this.refresh();
  }

  /** @param {string} text */
  setSearch(text) {
    if (text === this.#search) return;
    this.#search = text;
    this.element.scrollTop = 0;
    this.refresh();
  }

  /**
   * @param {string} id
   * @param {number} [x]
   * @param {number} [y]
   */
  openMenu(id, x, y) {
    if (id === GLOBAL) return;
    if (!selection.isSelected(id)) selection.choose(id);
    this.refresh();
    this.focus();
    const row = this.list.row(id)?.row;
    if (!row) return; // it was removed meanwhile
    const { left, bottom } = row.getBoundingClientRect();
    actions.openActions(x ?? left + 40, y ?? bottom, {
      model: this.#model,
      rows: () => this.rows(),
      rename: (chosen) => this.rename(chosen),
      refresh: () => this.refresh(),
    });
  }

  close() {
    this.#ends.forEach((end) => end());
    this.list.close();
  }

  #all() {
    return [this.#global, ...this.#model.items];
  }

  /** @param {Item} item */
  #look(item) {
    const isAlone = selection.ids().size === 1 && selection.isSelected(item.id);
    return {
      isOpen: this.#search && item.isGroup ? true : folding.isOpen(item),
      isSelected: selection.isSelected(item.id),
      isTabStop: item.id === selection.active(),
      enabled: actions.isEnabled(item),
      hasRate: item.isActive && (isAlone || item.id === this.#pointer.hovered()),
      ...placeAmong(this.#model, item),
    };
  }

  // Shows what the viewer has now, and what was added just now.
  #update() {
    const { canvas, element } = this;
    const { items, byId } = this.#model;
    const hadFocus = canvas.contains(document.activeElement);
    const before = selection.active();
    folding.follow(this.#all());
    const added = selection.follow(this.#all());
    const item = added && byId.get(added);
    if (item) this.#uncover(item);
    this.refresh();
    if (added) this.list.reveal(added);
    else if (!this.#isThere && items.length) element.scrollTop = recall(SCROLL_KEY, 0);
    this.#isThere ||= items.length > 0;
    if (hadFocus && (selection.active() !== before || !canvas.contains(document.activeElement)))
      this.focus();
    if (this.#toRename && byId.has(this.#toRename)) this.rename(this.#toRename);
  }

  /** @param {Item} item that neither the search nor a folded group shall hide */
  #uncover(item) {
    if (!matches(item, wordsOf(this.#search))) this.#search = "";
    for (let { parent } = item; parent; { parent } = parent) folding.setOpen(parent, true);
  }
}

/** @param {Item} item */
function guess(item) {
  const status = item.line && item.isActive ? GUESS.status : 0;
  return touchable(26) + status + (folding.isOpen(item) && !item.isGroup ? GUESS.inside : 0);
}

/** @param {HTMLElement} element */
function rememberScroll(element) {
  let scrolled = 0;
  element.addEventListener("scroll", () => {
    clearTimeout(scrolled);
    scrolled = setTimeout(() => remember(SCROLL_KEY, Math.round(element.scrollTop)), HOVER_MS);
  });
}
