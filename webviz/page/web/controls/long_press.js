// A finger that rests on something: it has no mouse to rest there.

const HOLD_MS = 450;
const STILL_PX = 10;
const CLICK_MS = 50; // after a release, within which its click comes

/**
 * Calls `run` once a finger has rested. Lifting it afterwards clicks, unless `run` returned true.
 *
 * @param {EventTarget} element
 * @param {(event: PointerEvent) => boolean} run
 */
export function listenToLongPresses(element, run) {
  let timer = 0;
  let [x, y] = [0, 0];
  const end = () => clearTimeout(timer);
  /** @param {Event} event */
  function begin(event) {
    end(); // a second finger is a gesture
    const down = /** @type {PointerEvent} */ (event);
    if (down.pointerType !== "touch" || !down.isPrimary) return;
    [x, y] = [down.clientX, down.clientY];
    timer = setTimeout(() => run(down) && swallowClickOfRelease(), HOLD_MS);
  }
  /** @param {Event} event */
  function move(event) {
    const { clientX, clientY } = /** @type {PointerEvent} */ (event);
    if (Math.hypot(clientX - x, clientY - y) > STILL_PX) end();
  }
  element.addEventListener("pointerdown", begin);
  element.addEventListener("pointermove", move);
  for (const name of ["pointerup", "pointercancel"]) element.addEventListener(name, end);
}

/** Takes the click of the release that comes next. */
export function swallowClickOfRelease() {
  addEventListener("pointerup", swallowClick, { capture: true, once: true });
}

/** Takes the click that a release has just made. */
export function swallowClick() {
  /** @param {Event} event */
  const stop = (event) => {
    event.stopPropagation();
    event.preventDefault();
  };
  addEventListener("click", stop, { capture: true, once: true });
  setTimeout(() => removeEventListener("click", stop, { capture: true }), CLICK_MS);
}
