// The order of elements, without taking the focus from one.

/** Puts children in order; what is gone goes first, and what has the focus is never moved. */
export function setChildren(element, children) {
  const wanted = new Set(children);
  for (const child of [...element.children]) if (!wanted.has(child)) child.remove();
  if (!children.length) return;
  let start = children.findIndex((child) => child.contains(document.activeElement));
  if (start < 0) {
    start = 0;
    if (element.firstElementChild !== children[0]) element.prepend(children[0]);
  }
  for (let i = start - 1; i >= 0; i--) {
    const next = children[i + 1];
    if (next.previousElementSibling !== children[i]) next.before(children[i]);
  }
  for (let i = start + 1; i < children.length; i++) {
    const before = children[i - 1];
    if (before.nextElementSibling !== children[i]) before.after(children[i]);
  }
}
