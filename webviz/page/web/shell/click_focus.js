// The keyboard after a click.

/**
 * Takes the focus from the buttons within an element once they are clicked, so that Space, arrows
 * and letters go on to mean the scene and the timeline. Buttons reached with Tab keep it.
 *
 * @param {HTMLElement} element
 */
export function keepKeysFree(element) {
  // Before the button's own listener: a menu that it opens gives the focus back to where it was.
  element.addEventListener("click", free, { capture: true });
}

/** @param {MouseEvent} event */
function free({ detail, target }) {
  const isByPointer = detail > 0;
  if (!isByPointer || !(target instanceof Element)) return;
  target.closest("button")?.blur();
}
