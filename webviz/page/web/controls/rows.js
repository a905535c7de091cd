// A list or tree of rows of one height, of which only those that are seen are in the page.
//
// The list has the focus; arrow keys move the row that is marked, which screen readers announce.

import { el, set } from "../dom.js";

/** @typedef {HTMLElement & {wvKey: string, wvTop?: number, wvDepth?: number}} Row */

const BEYOND = 6; // rows above and below what is seen that are there too

const INDENT_PX = 14;
const FINGER_PX = 40;

let lists = 0;

/**
 * `role` is that of the list, `rowRole` that of its rows. `make(item)` returns an element, which
 * `update(element, item)` fills in; items have a `key`. `choose(item)` is called on click and Enter.
 * `onKey(event, item)` may take a key before the list does, and returns whether it did. `host` is what
 * has the focus instead, such as a grid whose rows of heads are above.
 *
 * Returns `{element, show(items), resize(height), mark(key), marked()}`; `height` is of a row in pixels.
 *
 * @template {{key: string}} T
 * @template {HTMLElement} [E=HTMLElement]
 * @param {{
 *   label: string, role?: string, rowRole?: string, height: number, make: (item: T) => E,
 *   update: (row: E, item: T) => void, choose?: (item: T) => void,
 *   onKey?: (event: KeyboardEvent, item: T) => boolean, host?: HTMLElement | null,
 * }} options
 */
export function rowList({
  label,
  role = "listbox",
  rowRole = "option",
  height,
  make,
  update,
  choose,
  onKey = () => false,
  host = null,
}) {
  lists += 1;
  const id = `wv-rows-${lists}`;
  /** @type {Map<string, Row & E>} */
  const mounted = new Map();
  /** @type {Map<string, number>} */
  const places = new Map();
  let numbers = 0;
  /** @type {T[]} */
  let items = [];
  /** @type {string | null} */
  let marked = null;
  let total = -1;

  const canvas = el("div", { class: "wv-rows-canvas", role: "presentation" });
  const element = el(
    "div",
    {
      class: "wv-rows",
      role: host ? "rowgroup" : null,
      onscroll: () => render(),
      onclick: (event) => {
        const key = event.target.closest(".wv-row")?.wvKey;
        if (key === undefined || event.target.closest("button")) return;
        mark(key);
        const item = itemOf(key);
        if (item) choose?.(item);
      },
    },
    canvas,
  );
  /** @param {string | null} key */
  const itemOf = (key) => (key === null ? undefined : items[places.get(key) ?? -1]);
  const focused = host ?? element;
  set(focused, { role, tabindex: 0, "aria-label": label, onkeydown: press });
  let seenHeight = 0;
  const observer = new ResizeObserver(() => {
    const isSmaller = element.clientHeight < seenHeight;
    seenHeight = element.clientHeight;
    if (isSmaller && marked !== null)
      mark(marked); // what was chosen stays in sight
    else render();
  });
  observer.observe(element);

  /** @param {T[]} next */
  function show(next) {
    items = next;
    places.clear();
    items.forEach((item, index) => places.set(item.key, index));
    if (marked !== null && !places.has(marked)) marked = null;
    render(true);
  }

  function render(isChanged = false) {
    if (total !== items.length * height) {
      total = items.length * height;
      canvas.style.height = `${total}px`;
      isChanged = true;
    }
    const first = Math.max(0, Math.floor(element.scrollTop / height) - BEYOND);
    const last = Math.ceil((element.scrollTop + element.clientHeight) / height) + BEYOND;
    const seen = items.slice(first, last);
    const wanted = new Set(seen.map(({ key }) => key));
    for (const [key, row] of mounted) {
      if (wanted.has(key)) continue;
      row.remove();
      mounted.delete(key);
    }
    seen.forEach((item, index) => {
      const known = mounted.get(item.key);
      const row = known ?? mount(item);
      const isNew = !known;
      mounted.set(item.key, row);
      place(row, first + index);
      if (isNew || isChanged === true) update(row, item);
      if (canvas.children[index] !== row) canvas.insertBefore(row, canvas.children[index] ?? null);
    });
    showMark();
  }

  /** @param {T} item */
  function mount(item) {
    numbers += 1;
    const row = /** @type {Row & E} */ (make(item));
    row.classList.add("wv-row");
    set(row, { id: `${id}-${numbers}`, role: rowRole });
    row.wvKey = item.key;
    return row;
  }

  /**
   * @param {Row} row
   * @param {number} index
   */
  function place(row, index) {
    if (row.wvTop !== index * height) row.style.top = `${(row.wvTop = index * height)}px`;
    if (rowRole === "row") set(row, { "aria-rowindex": index + 2 });
    else set(row, { "aria-posinset": index + 1, "aria-setsize": items.length });
  }

  function showMark() {
    for (const [key, row] of mounted) set(row, { "aria-selected": String(key === marked) });
    set(focused, { "aria-activedescendant": mounted.get(marked ?? "")?.id });
  }

  /** @param {string} key */
  function mark(key) {
    marked = key;
    const index = places.get(key);
    if (index !== undefined) {
      const top = index * height;
      if (top < element.scrollTop) element.scrollTop = top;
      const over = top + height - element.scrollTop - element.clientHeight;
      if (over > 0) element.scrollTop += over;
    }
    render();
  }

  /** @param {KeyboardEvent} event */
  function press(event) {
    const { key } = event;
    if (event.target !== focused || event.ctrlKey || event.metaKey || event.altKey) return;
    const at = places.get(marked ?? "") ?? -1;
    const page = Math.max(1, Math.floor(element.clientHeight / height) - 1);
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
    if (items[at] && onKey(event, items[at])) {
      // done
    } else if (next !== undefined && items.length) {
      mark(items[Math.max(0, Math.min(next, items.length - 1))].key);
    } else if ((key === "Enter" || key === " ") && items[at]) choose?.(items[at]);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  return {
    element,
    show,
    mark,
    marked: () => itemOf(marked) ?? null,
    /** @param {number} pixels */
    resize(pixels) {
      if (pixels === height) return;
      height = pixels;
      render(true);
    },
    close: () => observer.disconnect(),
  };
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
