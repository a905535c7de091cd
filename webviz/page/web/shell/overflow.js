// A bar that is as long as there is space: what does not fit is made smaller or goes into a menu.

/** @import {MenuItem} from "webviz/controls/menu.js" */

/** @typedef {{element: HTMLElement, items: () => (MenuItem | null)[]}} Part */

/**
 * Lets a bar fit. `steps` are taken one after the other while there is not enough space: the name of
 * a class of the bar, or `{element, items()}`, whose element goes into the menu. `more` is the button
 * that is shown then. Returns `{layout, watch(around), hiddenItems}`.
 *
 * @param {HTMLElement} bar
 * @param {HTMLElement} more
 * @param {(string | Part)[]} steps
 */
export function fit(bar, more, steps) {
  const parts = steps.filter((step) => typeof step !== "string");
  const classes = steps.filter((step) => typeof step === "string");
  /** @type {HTMLElement | null} */
  let around = null;
  const isFull = () => bar.scrollWidth > bar.clientWidth;

  function layout() {
    if (!around?.clientWidth) return;
    bar.classList.remove(...classes);
    more.hidden = true;
    for (const part of parts) part.element.hidden = false;
    for (const step of steps) {
      if (!isFull()) break;
      if (typeof step === "string") bar.classList.add(step);
      else {
        step.element.hidden = true;
        more.hidden = false;
      }
    }
  }

  function hiddenItems() {
    const groups = parts
      .filter(({ element }) => element.hidden)
      .map(({ items }) => items())
      .reverse();
    return groups.flatMap((items, index) =>
      index && items.length + groups[index - 1].length > 2 ? [null, ...items] : items,
    );
  }

  return {
    layout,
    hiddenItems,
    /** @param {HTMLElement} element */
    watch(element) {
      around = element;
      new ResizeObserver(layout).observe(element);
    },
  };
}
