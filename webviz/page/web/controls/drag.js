// Dragging a number sideways, by its field or by its label.

const DRAG_PX = 4; // less is a click
const COARSE = 10;

/**
 * Calls `move(start, pixels, isFine)` while a handle of a field is dragged; `begin()` returns the
 * start, null for not at all. Shift makes it ten times coarser, Alt ten times finer. A click selects
 * what is in the field.
 *
 * @template {object} S
 * @param {HTMLElement} handle
 * @param {HTMLInputElement} input
 * @param {{begin: () => S | null, move: (start: S, pixels: number, isFine: boolean) => void, end: () => void}} drag
 */
export function drag(handle, input, { begin, move, end }) {
  /** @type {{start: S | null, x: number, by: number, isDragged: boolean} | null} */
  let from = null;

  handle.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || document.activeElement === handle) return;
    event.preventDefault(); // the field gets the focus when this turns out to be a click
    from = { start: begin(), x: event.clientX, by: 0, isDragged: false };
    handle.setPointerCapture(event.pointerId);
  });
  handle.addEventListener("pointermove", (event) => {
    if (!from?.start) return;
    const by = event.clientX - from.x;
    if (!from.isDragged && Math.abs(by) < DRAG_PX) return;
    from.isDragged = true;
    from.x = event.clientX;
    from.by += by * (event.shiftKey ? COARSE : event.altKey ? 1 / COARSE : 1);
    move(from.start, from.by, event.altKey);
  });
  /** @param {PointerEvent} event */
  const finish = ({ type }) => {
    if (!from) return;
    const { isDragged } = from;
    from = null;
    if (isDragged) end();
    else if (type === "pointerup") {
      input.focus();
      input.select();
    }
  };
  handle.addEventListener("pointerup", finish);
  handle.addEventListener("pointercancel", finish);
}
