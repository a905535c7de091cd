// A list or tree of rows of one height, of which only those that are seen are in the page.
//
// The list has the focus; arrow keys move the row that is marked, which screen readers announce.

import { el, newId, set } from "../dom.js";
import { batch, effect, owned, root, signal, untracked } from "../signals.js";

/** @import {Signal} from "../signals.js" */
/** @import {End} from "../types.js" */

/** @typedef {HTMLElement & {wvKey: string, wvDepth?: number}} Row */

/**
 * A row in the page: it is made once, and follows its item.
 *
 * @template T
 * @typedef {{element: Row, item: Signal<T>, end: End}} Mounted
 */

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
  /** @type {Map<string, Mounted<T>>} */
  #mounted = new Map();
  /** @type {Map<string, number>} */
  #places = new Map();
  /** @type {T[]} */
  #items = [];
  #shown = signal(0); // counts what was shown
  #marked = signal(/** @type {string | null} */ (null));
  #canvas = el("div", { class: "wv-rows-canvas", role: "presentation" });
  #seenHeight = 0;
  #observer = new ResizeObserver(() => this.#resized());

  /** @param {Options<T, E>} options */
  constructor(options) {
    const { label, role = "listbox", height, host } = options;
    this.#options = options;
    this.#height = height;
    this.element = el(
      "div",
      {
        class: "wv-rows",
        role: host ? "rowgroup" : null,
        onscroll: () => this.#render(),
        onclick: (/** @type {MouseEvent} */ event) => this.#click(event),
      },
      this.#canvas,
    );
    this.focused = host ?? this.element;
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
    this.#items = items;
    this.#places = new Map(items.map(({ key }, index) => [key, index]));
    batch(() => {
      if (!this.#places.has(this.#marked.value ?? "")) this.#marked.value = null;
      this.#shown.value += 1;
      this.#render();
    });
  }

  marked() {
    return this.#shown.value ? (this.#itemOf(this.#marked.value) ?? null) : null;
  }

  /** @param {string} key */
  mark(key) {
    this.#marked.value = key;
    const index = this.#places.get(key);
    if (index !== undefined) {
      const { element } = this;
      const top = index * this.#height;
      if (top < element.scrollTop) element.scrollTop = top;
      const over = top + this.#height - element.scrollTop - element.clientHeight;
      if (over > 0) element.scrollTop += over;
    }
    this.#render();
  }

  /** @param {number} pixels */
  resize(pixels) {
    if (pixels === this.#height) return;
    this.#height = pixels;
    this.#render();
  }

  close() {
    this.#observer.disconnect();
    for (const { end } of this.#mounted.values()) end();
  }

  #resized() {
    const isSmaller = this.element.clientHeight < this.#seenHeight;
    this.#seenHeight = this.element.clientHeight;
    // What was chosen stays in sight.
    if (isSmaller && this.#marked.value !== null) this.mark(this.#marked.value);
    else this.#render();
  }

  #render() {
    const { scrollTop, clientHeight } = this.element;
    const total = `${this.#items.length * this.#height}px`;
    if (this.#canvas.style.height !== total) this.#canvas.style.height = total;
    const first = Math.max(0, Math.floor(scrollTop / this.#height) - BEYOND);
    const last = Math.ceil((scrollTop + clientHeight) / this.#height) + BEYOND;
    const seen = this.#items.slice(first, last);
    const wanted = new Set(seen.map(({ key }) => key));
    for (const [key, { element, end }] of this.#mounted) {
      if (wanted.has(key)) continue;
      end();
      element.remove();
      this.#mounted.delete(key);
    }
    seen.forEach((item, index) => {
      const known = this.#mounted.get(item.key);
      const { element, item: own } = known ?? root((end) => this.#mount(item, end));
      own.value = item;
      this.#place(element, first + index);
      const before = this.#canvas.children[index] ?? null;
      if (before !== element) this.#canvas.insertBefore(element, before);
    });
    const id = this.#mounted.get(this.#marked.value ?? "")?.element.id;
    set(this.focused, { "aria-activedescendant": id });
  }

  /**
   * @param {T} first
   * @param {End} end
   */
  #mount(first, end) {
    const { row, make, update, rowRole = "option" } = this.#options;
    const { key } = first;
    const item = signal(first);
    const element = /** @type {Row & E} */ (row?.(() => item.value) ?? make?.(first));
    this.#numbers += 1;
    element.classList.add("wv-row");
    element.wvKey = key;
    set(element, {
      id: `${this.#id}-${this.#numbers}`,
      role: rowRole,
      "aria-selected": () => String(this.#marked.value === key),
    });
    effect(() => {
      if (this.#shown.value) update?.(element, item.value);
    });
    const mounted = { element, item, end };
    this.#mounted.set(key, mounted);
    return mounted;
  }

  /**
   * @param {Row} row
   * @param {number} index
   */
  #place(row, index) {
    const top = `${index * this.#height}px`;
    if (row.style.top !== top) row.style.top = top;
    if (this.#options.rowRole === "row") set(row, { "aria-rowindex": index + 2 });
    else set(row, { "aria-posinset": index + 1, "aria-setsize": this.#items.length });
  }

  /** @param {string | null} key */
  #itemOf(key) {
    return key === null ? undefined : this.#items[this.#places.get(key) ?? -1];
  }

  /** @param {MouseEvent} event */
  #click({ target }) {
    const clicked = /** @type {Element} */ (target);
    const row = /** @type {Row | null} */ (clicked.closest(".wv-row"));
    const item = row && this.#itemOf(row.wvKey);
    if (!item || clicked.closest("button")) return;
    this.mark(item.key);
    this.#options.choose?.(item);
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    const { key } = event;
    if (event.target !== this.focused || event.ctrlKey || event.metaKey || event.altKey) return;
    const at = this.#places.get(this.#marked.value ?? "") ?? -1;
    const item = this.#items[at];
    const page = Math.max(1, Math.floor(this.element.clientHeight / this.#height) - 1);
    /** @type {Record<string, number>} */
    const steps = {
      ArrowDown: at + 1,
      ArrowUp: at - 1,
      PageDown: at + page,
      PageUp: at - page,
      Home: 0,
      End: this.#items.length - 1,
    };
    const next = steps[key];
    if (item && this.#options.onKey?.(event, item)) {
      // done
    } else if (next !== undefined && this.#items.length) {
      this.mark(this.#items[Math.max(0, Math.min(next, this.#items.length - 1))].key);
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
