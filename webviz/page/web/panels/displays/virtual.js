// A long list of which only what is seen is in the page.
//
// Rows are as high as what is in them; before one has been seen, its height is a guess.

import { setChildren } from "../../dom.js";

const BEYOND = 300; // pixels above and below what is seen that are there too
const SETTLED_MS = 300; // by then, rows that come into sight have been measured

/**
 * A list in `scroller`, whose rows are put into `canvas`.
 *
 * `make(item)` returns `{element, update(item), close()}`; `guess(item)` a height in pixels;
 * `isHeld(id)` whether a row stays although it is not seen.
 *
 * @template {{id: string}} T
 * @template {{element: HTMLElement, update: (item: T) => void, close: () => void}} R
 * @param {{
 *   scroller: HTMLElement, canvas: HTMLElement, make: (item: T) => R, guess: (item: T) => number,
 *   isHeld: (id: string) => boolean,
 * }} options
 */
export function virtualList({ scroller, canvas, make, guess, isHeld }) {
  /** @type {Map<string, R>} */
  const mounted = new Map();
  /** @type {Map<string, number>} */
  const heights = new Map();
  /** @type {T[]} */
  let items = [];
  let tops = [0]; // one more than items
  let width = 0;
  let frame = 0;
  /** @type {{id: string, most: number, until: number} | null} */
  let goal = null; // the row that was to be seen

  const measured = new ResizeObserver((entries) => {
    let isNew = false;
    for (const entry of entries) {
      const target = /** @type {HTMLElement} */ (entry.target);
      const { id } = target.dataset;
      const height = target.offsetHeight;
      if (id === undefined || !target.isConnected || heights.get(id) === height) continue;
      heights.set(id, height);
      isNew = true;
    }
    if (!isNew) return;
    place();
    if (goal && performance.now() < goal.until) scrollTo(goal);
    later();
  });
  const resized = new ResizeObserver(() => {
    if (canvas.offsetWidth !== width) {
      width = canvas.offsetWidth; // other lines break now
      for (const id of heights.keys()) if (!mounted.has(id)) heights.delete(id);
    }
    later();
  });
  const onScroll = () => mount();
  resized.observe(scroller);
  scroller.addEventListener("scroll", onScroll);

  /** @param {T} item */
  const heightOf = (item) => heights.get(item.id) ?? guess(item);
  /** @param {string} id */
  const indexOf = (id) => items.findIndex((item) => item.id === id);

  // What happens in an observer must not add rows that are observed in the same frame.
  function later() {
    frame ||= requestAnimationFrame(() => {
      frame = 0;
      mount();
    });
  }

  /**
   * Keeps in place what is seen while something above it comes, goes, or has another height.
   *
   * @param {T[]} [next]
   */
  function place(next = items) {
    const anchor = scroller.scrollTop > 0 ? items[at(scroller.scrollTop)] : null;
    const before = anchor ? tops[indexOf(anchor.id)] : 0;
    items = next;
    measure();
    const index = anchor ? indexOf(anchor.id) : -1;
    if (index >= 0 && tops[index] !== before) scroller.scrollTop += tops[index] - before;
  }

  function measure() {
    tops = [0];
    for (const item of items) tops.push(tops[tops.length - 1] + heightOf(item));
    canvas.style.height = `${tops.at(-1)}px`;
    items.forEach((item, index) => {
      const row = mounted.get(item.id);
      if (row) row.element.style.top = `${tops[index]}px`;
    });
  }

  /**
   * The index of the row at a height in pixels of the canvas.
   *
   * @param {number} y
   */
  function at(y) {
    const index = tops.findIndex((top) => top > y) - 1;
    return index < -1 ? items.length - 1 : Math.max(index, 0);
  }

  /** @param {{id: string, most: number}} goal */
  function scrollTo({ id, most }) {
    const index = indexOf(id);
    if (index < 0) return;
    const top = tops[index] + canvas.offsetTop;
    const bottom = Math.min(tops[index + 1] + canvas.offsetTop, top + most);
    if (top < scroller.scrollTop) scroller.scrollTop = index === 0 ? 0 : top;
    else if (bottom > scroller.scrollTop + scroller.clientHeight) {
      scroller.scrollTop = bottom - scroller.clientHeight;
    }
  }

  /** @param {boolean} [isChanged] */
  function mount(isChanged = false) {
    const top = scroller.scrollTop - canvas.offsetTop;
    const [first, last] = [at(top - BEYOND), at(top + scroller.clientHeight + BEYOND)];
    const shown = items.filter(({ id }, index) => {
      const isFocused = mounted.get(id)?.element.contains(document.activeElement);
      return (index >= first && index <= last) || isFocused || isHeld(id);
    });
    const wanted = new Set(shown.map(({ id }) => id));
    for (const [id, row] of mounted) {
      if (wanted.has(id)) continue;
      measured.unobserve(row.element);
      row.close();
      row.element.remove();
      mounted.delete(id);
    }
    /** @type {HTMLElement[]} */
    const made = [];
    for (const item of shown) {
      let row = mounted.get(item.id);
      if (!row) {
        mounted.set(item.id, (row = make(item)));
        row.element.style.top = `${tops[indexOf(item.id)]}px`;
        made.push(row.element);
      } else if (!isChanged) continue;
      row.update(item);
    }
    setChildren(
      canvas,
      shown.flatMap(({ id }) => mounted.get(id)?.element ?? []),
    );
    for (const element of made) measured.observe(element);
  }

  return {
    /**
     * Shows these items; those with an id from before keep their rows.
     *
     * @param {T[]} next
     */
    show(next) {
      place(next);
      mount(true);
    },
    /**
     * The row of an id, if it is in the page.
     *
     * @param {string | null | undefined} id
     * @returns {R | null}
     */
    row: (id) => (id && mounted.get(id)) || null,
    /** The rows in the page. */
    rows: () => [...mounted.values()],
    at,
    /**
     * Top and height of a row in pixels of the canvas.
     *
     * @param {number} index
     */
    span(index) {
      return { top: tops[index], height: tops[index + 1] - tops[index] };
    },
    /**
     * Scrolls no further than it takes to see a row, or the first `most` pixels of it.
     *
     * @param {string | null} id
     * @param {number} [most]
     */
    reveal(id, most = 60) {
      if (id === null) return;
      goal = { id, most, until: performance.now() + SETTLED_MS };
      scrollTo(goal);
      mount();
    },
    close() {
      cancelAnimationFrame(frame);
      measured.disconnect();
      resized.disconnect();
      scroller.removeEventListener("scroll", onScroll);
      for (const row of mounted.values()) row.close();
    },
  };
}
