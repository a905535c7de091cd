// A long list of which only the rows that are seen are in the page.
//
// Rows have one height, or each that of its content, which is a guess until it has been seen.

import { setChildren } from "webviz/dom.js";
import { batch, owned, root, signal, untracked } from "webviz/signals.js";

/** @import {Signal} from "webviz/signals.js" */
/** @import {End} from "webviz/types.js" */

const SETTLED_MS = 300; // by then, rows that come into sight have been measured

/**
 * Height and place of rows by their index: `measure(elements)` is called with those that came into the
 * page, `close()` at the end.
 *
 * @typedef {{
 *   isFixed: boolean, lay(keys: string[]): void, top(index: number): number, at(y: number): number,
 *   watch(key: string, element: HTMLElement): void, unwatch(element: HTMLElement): void,
 *   forget(kept: (key: string) => boolean): void, close(): void,
 * }} Heights
 */

/**
 * A row in the page; it is made once, and follows its item.
 *
 * @template T, R
 * @typedef {{content: R, item: Signal<T>, index: Signal<number>, end: End}} Mounted
 */

/**
 * Rows of one height in pixels; the function may return another one later.
 *
 * @param {() => number} height
 * @returns {Heights}
 */
export function fixedHeights(height) {
  let count = 0;
  return {
    isFixed: true,
    lay: ({ length }) => (count = length),
    top: (index) => index * height(),
    at: (y) => Math.max(0, Math.min(Math.floor(y / height()), count - 1)),
    watch() {},
    unwatch() {},
    forget() {},
    close() {},
  };
}

/**
 * Rows as high as what is in them; `guess(key)` is a height before a row has been seen, and `changed`
 * is called when one turns out to have another.
 *
 * @param {(key: string) => number} guess
 * @param {() => void} changed
 * @returns {Heights}
 */
export function measuredHeights(guess, changed) {
  /** @type {Map<string, number>} */
  const heights = new Map();
  /** @type {WeakMap<Element, string>} */
  const keys = new WeakMap();
  let tops = [0]; // one more than rows
  const observer = new ResizeObserver((entries) => {
    let isNew = false;
    for (const { target } of entries) {
      const key = keys.get(target);
      const { offsetHeight: height } = /** @type {HTMLElement} */ (target);
      if (key === undefined || !target.isConnected || heights.get(key) === height) continue;
      heights.set(key, height);
      isNew = true;
    }
    if (isNew) changed();
  });
  return {
    isFixed: false,
    lay(all) {
      tops = [0];
      for (const key of all) tops.push(tops[tops.length - 1] + (heights.get(key) ?? guess(key)));
    },
    top: (index) => tops[index],
    at(y) {
      const index = tops.findIndex((top) => top > y) - 1;
      return index < -1 ? tops.length - 2 : Math.max(index, 0);
    },
    watch(key, element) {
      keys.set(element, key);
      observer.observe(element);
    },
    unwatch: (element) => observer.unobserve(element),
    forget(isKept) {
      for (const key of heights.keys()) if (!isKept(key)) heights.delete(key);
    },
    close: () => observer.disconnect(),
  };
}

/**
 * The list itself: items in `scroller`, whose rows are put into `canvas`.
 *
 * `keyOf` names an item. `make(item, index)` makes a row, an object with an `element`, that reads its item and
 * its place in effects; they read anew whenever items are shown. `height` is that of each row in pixels, or `guess(item)` one of an
 * item that has not been seen. `held()` is the key of a row that stays although it is not seen.
 * `beyond` is how many pixels above and below what is seen are there, too.
 *
 * @template T
 * @template {{element: HTMLElement}} R
 */
export class VirtualList {
  #options;
  /** @type {Map<string, Mounted<T, R>>} */
  #mounted = new Map();
  /** @type {T[]} */
  #items = [];
  /** @type {Map<string, number>} */
  #places = new Map();
  #revision = signal(0); // rises with each list that is shown
  /** @type {Heights} */
  #heights;
  #width = 0;
  #frame = 0;
  /** @type {{key: string, most: number, until: number} | null} */
  #goal = null; // the row that was to be seen
  #resized = new ResizeObserver(() => this.#resize());
  #onScroll = () => this.mount();

  /**
   * @param {{
   *   scroller: HTMLElement, canvas: HTMLElement, keyOf: (item: T) => string,
   *   make: (item: () => T, index: () => number, key: string) => R,
   *   height?: () => number, guess?: (item: T) => number, activeKey: () => string | null,
   *   beyond: () => number,
   * }} options
   */
  constructor(options) {
    this.#options = options;
    const { height, guess = () => 0, scroller } = options;
    this.#heights = height
      ? fixedHeights(height)
      : measuredHeights(
          (key) => guess(this.#items[this.indexOf(key)]),
          () => this.#measured(),
        );
    this.#resized.observe(scroller);
    scroller.addEventListener("scroll", this.#onScroll);
    owned(() => this.close());
  }

  /** The items; read in effects. */
  items() {
    return this.#revision.value ? this.#items : [];
  }

  /**
   * Shows these items; those with a key from before keep their rows.
   *
   * @param {T[]} items
   */
  show(items) {
    untracked(() =>
      batch(() => {
        this.#lay(items);
        this.#revision.value += 1;
        this.mount();
      }),
    );
  }

  /**
   * The place of a key among the items, -1 if it is not there.
   *
   * @param {string | null | undefined} key
   */
  indexOf(key) {
    return this.#places.get(key ?? "") ?? -1;
  }

  /**
   * The row of a key, if it is in the page.
   *
   * @param {string | null | undefined} key
   */
  row(key) {
    return this.#mounted.get(key ?? "")?.content ?? null;
  }

  /**
   * The index of the row at a height in pixels of the canvas.
   *
   * @param {number} y
   */
  at(y) {
    return this.#heights.at(y);
  }

  /**
   * Top and height of a row in pixels of the canvas.
   *
   * @param {number} index
   */
  span(index) {
    const top = this.#heights.top(index);
    return { top, height: this.#heights.top(index + 1) - top };
  }

  /**
   * Scrolls no further than it takes to see a row, or the first `most` pixels of it.
   *
   * @param {string | null} key
   * @param {number} [most]
   */
  reveal(key, most = 60) {
    if (key === null) return;
    this.#goal = { key, most, until: performance.now() + SETTLED_MS };
    this.#scrollTo(this.#goal);
    this.mount();
  }

  /** Rows have another height now. */
  resize() {
    this.#lay(this.#items);
    this.mount();
  }

  /** Puts the rows into the page that are seen. */
  mount() {
    const { scroller, canvas, keyOf, activeKey, beyond } = this.#options;
    const { scrollTop, clientHeight } = scroller;
    const top = scrollTop - canvas.offsetTop;
    const [first, last] = [this.at(top - beyond()), this.at(top + clientHeight + beyond())];
    const keys = new Set(this.#items.slice(first, last + 1).map(keyOf));
    const stays = activeKey();
    if (stays !== null && this.#places.has(stays)) keys.add(stays);
    for (const [key, { content }] of this.#mounted) {
      if (this.#places.has(key) && content.element.contains(document.activeElement)) keys.add(key);
      if (!keys.has(key)) this.#unmount(key);
    }
    const order = [...keys].sort((a, b) => this.indexOf(a) - this.indexOf(b));
    /** @type {[string, HTMLElement][]} */
    const added = [];
    untracked(() =>
      batch(() => {
        for (const key of order) {
          if (this.#follow(key)) added.push([key, this.#row(key).element]);
        }
      }),
    );
    setChildren(
      canvas,
      order.map((key) => this.#row(key).element),
    );
    for (const [key, element] of added) this.#heights.watch(key, element);
  }

  close() {
    cancelAnimationFrame(this.#frame);
    this.#heights.close();
    this.#resized.disconnect();
    this.#options.scroller.removeEventListener("scroll", this.#onScroll);
    for (const { end } of this.#mounted.values()) end();
    this.#mounted.clear();
  }

  /** @param {string} key */
  #row(key) {
    return /** @type {Mounted<T, R>} */ (this.#mounted.get(key)).content;
  }

  /**
   * Makes a row, or gives it its item anew; whether it was made.
   *
   * @param {string} key
   */
  #follow(key) {
    const at = this.indexOf(key);
    const item = this.#items[at];
    let row = this.#mounted.get(key);
    const isNew = !row;
    row ??= root((end) => this.#make(key, item, at, end));
    row.item.value = item;
    row.index.value = at;
    row.content.element.style.top = `${this.#heights.top(at)}px`;
    return isNew;
  }

  /**
   * @param {string} key
   * @param {T} first
   * @param {number} at
   * @param {End} end
   */
  #make(key, first, at, end) {
    const [item, index] = [signal(first), signal(at)];
    const read = () => (this.#revision.value ? item.value : first);
    const row = { content: this.#options.make(read, () => index.value, key), item, index, end };
    this.#mounted.set(key, row);
    return row;
  }

  /** @param {string} key */
  #unmount(key) {
    const { content, end } = /** @type {Mounted<T, R>} */ (this.#mounted.get(key));
    this.#heights.unwatch(content.element);
    end();
    content.element.remove();
    this.#mounted.delete(key);
  }

  /**
   * Takes up items; what is seen stays in place while rows of any height come and go above it.
   *
   * @param {T[]} items
   */
  #lay(items) {
    const { scroller, canvas, keyOf } = this.#options;
    const isKept = !this.#heights.isFixed && scroller.scrollTop > 0 && this.#items.length > 0;
    const topIndex = isKept ? this.at(scroller.scrollTop) : -1;
    const anchor = isKept ? keyOf(this.#items[topIndex]) : "";
    const before = isKept ? this.#heights.top(topIndex) : 0;
    this.#items = items;
    const keys = items.map(keyOf);
    this.#places = new Map(keys.map((key, index) => [key, index]));
    this.#heights.lay(keys);
    const height = `${this.#heights.top(items.length)}px`;
    if (canvas.style.height !== height) canvas.style.height = height;
    for (const [key, { content }] of this.#mounted) {
      const at = this.indexOf(key);
      if (at >= 0) content.element.style.top = `${this.#heights.top(at)}px`;
    }
    const index = isKept ? this.indexOf(anchor) : -1;
    const moved = index < 0 ? 0 : this.#heights.top(index) - before;
    if (moved) scroller.scrollTop += moved;
  }

  /** @param {{key: string, most: number}} goal */
  #scrollTo({ key, most }) {
    const { scroller, canvas } = this.#options;
    const index = this.indexOf(key);
    if (index < 0) return;
    const span = this.span(index);
    const top = span.top + canvas.offsetTop;
    const bottom = top + Math.min(span.height, most);
    if (top < scroller.scrollTop) scroller.scrollTop = index === 0 ? 0 : top;
    else if (bottom > scroller.scrollTop + scroller.clientHeight)
      scroller.scrollTop = bottom - scroller.clientHeight;
  }

  #measured() {
    this.#lay(this.#items);
    if (this.#goal && performance.now() < this.#goal.until) this.#scrollTo(this.#goal);
    this.#later();
  }

  #resize() {
    const { offsetWidth } = this.#options.canvas;
    // Other lines break now.
    if (offsetWidth !== this.#width) this.#heights.forget((key) => this.#mounted.has(key));
    this.#width = offsetWidth;
    this.#later();
  }

  // What happens in an observer must not add rows that are observed in the same frame.
  #later() {
    this.#frame ||= requestAnimationFrame(() => {
      this.#frame = 0;
      this.mount();
    });
  }
}
