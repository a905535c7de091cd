// A bar that is as long as there is space: what does not fit goes into a menu.

/**
 * Lets a bar fit. `parts`, `{element, items()}`, go one after the other, the first one first, when
 * there is not enough space; before that, names beside icons go. `more` is the button that is shown
 * then. Returns `{layout, watch(around), hiddenItems}`.
 */
export function fit(bar, more, parts) {
  let around = null;
  const isFull = () => bar.scrollWidth > bar.clientWidth;

  function layout() {
    if (!around?.clientWidth) return;
    bar.classList.remove("wv-compact");
    more.hidden = true;
    for (const part of parts) part.element.hidden = false;
    if (isFull()) bar.classList.add("wv-compact");
    for (const part of parts) {
      if (!isFull()) break;
      more.hidden = false;
      part.element.hidden = true;
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
    watch(element) {
      around = element;
      new ResizeObserver(layout).observe(element);
    },
  };
}
