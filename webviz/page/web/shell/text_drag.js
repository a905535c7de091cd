// Drags of selected text.

/**
 * Keeps selected text where it is, except in fields, links and what is made to be dragged: a browser that drags it cancels the
 * pointer, and with it the drag of the view, the timeline or a panel that begins over the text.
 */
export function keepTextStill() {
  document.addEventListener("dragstart", (event) => {
    const { target } = event;
    const isWanted =
      target instanceof Element && target.closest('a, input, textarea, [draggable="true"]');
    if (!isWanted) event.preventDefault();
  });
}
