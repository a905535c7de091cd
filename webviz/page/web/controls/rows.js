// A list or tree of rows of one height, of which only those that are seen are in the page.
//
// The list has the focus; arrow keys move the row that is marked, which screen readers announce.

import { el, newId, set } from "webviz/dom.js";
import { batch, effect, owned, signal, untracked } from "webviz/signals.js";
import { VirtualList } from "webviz/controls/virtual.js";

/** @typedef {HTMLElement & {wvKey: string, wvDepth?: number}} Row */

/**
 * `role` is that of the list, `rowRole` that of its rows. `row(item)` makes the element of an item,
 * which it reads by `item()` in effects; or `make(item)` makes one that `update(element, item)` fills in.
 * Items have a `key`. `choose(item)` is called on click and Enter. `onKey(event, item)` may take a key
 * before the list does, and returns whether it did. `host` is what has the focus instead, such as a grid
 * whose rows of heads are above.
 *
 * @template {{key: string}} T
 * @template {HTMLElement} E
 * @typedef {{
 *   label: string, role?: string, rowRole?: string, height: number, row?: (item: () => T) => E,
 *   make?: (item: T) => E, update?: (row: E, item: T) => void, choose?: (item: T) => void,
 *   onKey?: (event: KeyboardEvent, item: T) => boolean, host?: HTMLElement | null,
 * }} Options
 */

const BEYOND = 6; // rows above and below what is seen that are there too

const INDENT_PX = 14;
const FINGER_PX = 40;

/**
 * Returns `{element, show(items), resize(height), mark(key), marked(), close()}`; `height` is of a row
 * in pixels, and `marked()` is read in effects.
 *
 * @template {{key: string}} T
 * @template {HTMLElement} [E=HTMLElement]
 * @param {Options<T, E>} options
 */
export function rowList(options) {
  const list = new RowList(options);
  owned(() => list.close());
  return {
    element: list.element,
    show: (/** @type {T[]} */ items) => untracked(() => list.show(items)),
    mark: (/** @type {string} */ key) => untracked(() => list.mark(key)),
    marked: () => list.marked(),
    resize: (/** @type {number} */ pixels) => list.resize(pixels),
    close: () => list.close(),
  };
}

/**
 * @template {{key: string}} T
 * @template {HTMLElement} E
 */
class RowList {
  #id = newId("rows");
  #numbers = 0;
  #height;
  #options;
  /** @type {VirtualList<T, {element: Row}>} */
  #list;
  #marked = signal(/** @type {string | null} */ (null));
  #seenHeight = 0;
  #observer = new ResizeObserver(() => this.#resized());

  /** @param {Options<T, E>} options */
  constructor(options) {
    const { label, role = "listbox", height, host } = options;
    this.#options = options;
    this.#height = height;
    const canvas = el("div", { class: "wv-rows-canvas", role: "presentation" });
    const onclick = (/** @type {MouseEvent} */ event) => this.#click(event);
    this.element = el("div", { class: "wv-rows", role: host ? "rowgroup" : null, onclick }, canvas);
    this.focused = host ?? this.element;
    this.#list = new VirtualList({
      scroller: this.element,
      canvas,
      keyOf: ({ key }) => key,
      height: () => this.#height,
      beyond: () => BEYOND * this.#height,
      activeKey: () => untracked(() => this.#marked.value),
      make: (item, index, key) => this.#make(item, index, key),
    });
    set(this.focused, {
      role,
      tabindex: 0,
      "aria-label": label,
      onkeydown: (/** @type {KeyboardEvent} */ event) => this.#press(event),
    });
    this.#observer.observe(this.element);
  }

  /** @param {T[]} items */
  show(items) {
    batch(() => {
      this.#list.show(items);
      if (this.#list.indexOf(this.#marked.value) < 0) this.#marked.value = null;
    });
    this.#announce();
  }

  marked() {
    const items = this.#list.items();
    return items[this.#list.indexOf(this.#marked.value)] ?? null;
  }

  /** @param {string} key */
  mark(key) {
    this.#marked.value = key;
    this.#list.reveal(key, this.#height);
    this.#announce();
  }

  /** @param {number} pixels */
  resize(pixels) {
    if (pixels === this.#height) return;
    this.#height = pixels;
    this.#list.resize();
  }

  close() {
    this.#observer.disconnect();
    this.#list.close();
  }

  #resized() {
    const isSmaller = this.element.clientHeight < this.#seenHeight;
    this.#seenHeight = this.element.clientHeight;
    // What was chosen stays in sight.
    if (isSmaller && this.#marked.value !== null) this.mark(this.#marked.value);
  }

  #announce() {
    const id = this.#list.row(this.#marked.value)?.element.id;
    set(this.focused, { "aria-activedescendant": id });
  }

  /**
   * @param {() => T} item
   * @param {() => number} index
   * @param {string} key
   */
  #make(item, index, key) {
    const { row, make, update, rowRole = "option" } = this.#options;
    const element = /** @type {Row & E} */ (row?.(item) ?? make?.(item()));
    this.#numbers += 1;
    element.classList.add("wv-row");
    element.wvKey = key;
    set(element, {
      id: `${this.#id}-${this.#numbers}`,
      role: rowRole,
      "aria-selected": () => String(this.#marked.value === key),
      ...(rowRole === "row"
        ? { "aria-rowindex": () => index() + 2 }
        : {
            "aria-posinset": () => index() + 1,
            "aria-setsize": () => this.#list.items().length,
          }),
    });
    if (update) effect(() => update(element, item()));
    return { element };
  }

  /** @param {MouseEvent} event */
  #click({ target }) {
    const clicked = /** @type {Element} */ (target);
    const row = /** @type {Row | null} */ (clicked.closest(".wv-row"));
    const item = row && this.#list.items()[this.#list.indexOf(row.wvKey)];
    if (!item || clicked.closest("button")) return;
    this.mark(item.key);
    this.#options.choose?.(item);
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    const { key } = event;
    if (event.target !== this.focused || event.ctrlKey || event.metaKey || event.altKey) return;
    const items = this.#list.items();
    const at = this.#list.indexOf(this.#marked.value);
    const item = items[at];
    const page = Math.max(1, Math.floor(this.element.clientHeight / this.#height) - 1);
    /** @type {Record<string, number>} */
    const steps = {
      ArrowDown: at + 1,
      ArrowUp: at - 1,
      PageDown: at + page,
      PageUp: at - page,
      Home: 0,
      End: items.length - 1,
    };
    const next = steps[key];
    if (item && this.#options.onKey?.(event, item)) {
      // done
    } else if (next !== undefined && items.length) {
      this.mark(items[Math.max(0, Math.min(next, items.length - 1))].key);
    } else if ((key === "Enter" || key === " ") && item) this.#options.choose?.(item);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}

/**
 * The height of a row in pixels where fingers touch it.
 *
 * @param {number} height
 */
export function touchable(height) {
  return matchMedia("(pointer: coarse)").matches ? Math.max(height, FINGER_PX) : height;
}

/**
 * The key of the item whose row an element is in, "" for none.
 *
 * @param {Element} element
 */
export const keyOf = (element) =>
  /** @type {Row | null} */ (element.closest(".wv-row"))?.wvKey ?? "";

/**
 * Indents a row of a tree by its depth: `--wv-indent`.
 *
 * @param {HTMLElement} element
 * @param {number} depth
 */
export function indent(element, depth) {
  const row = /** @type {Row} */ (element);
  if (row.wvDepth === depth) return;
  row.wvDepth = depth;
  row.style.setProperty("--wv-indent", `${depth * INDENT_PX}px`);
}
