// Keys that drive while they are held, by their places on the keyboard.

/**
 * Of the highest speeds: ahead, to the left and counter-clockwise.
 *
 * @typedef {readonly number[]} Shares
 */

const [LINEAR, LATERAL, ANGULAR] = [0, 1, 2];
/** @type {Record<string, [axis: number, way: number]>} */
const KEYS = {
  KeyW: [LINEAR, 1],
  ArrowUp: [LINEAR, 1],
  KeyS: [LINEAR, -1],
  ArrowDown: [LINEAR, -1],
  KeyA: [ANGULAR, 1],
  ArrowLeft: [ANGULAR, 1],
  KeyD: [ANGULAR, -1],
  ArrowRight: [ANGULAR, -1],
  KeyQ: [LATERAL, 1],
  KeyE: [LATERAL, -1],
};

/** @type {Set<string>} */
const codes = new Set();

/**
 * Hold a key from now on, true if it is for driving. Q and E go sideways, if the robot can.
 *
 * @param {KeyboardEvent} event
 * @param {boolean} canGoSideways
 */
export function press(event, canGoSideways) {
  const [axis] = KEYS[event.code] ?? [];
  if (event.ctrlKey || event.metaKey || event.altKey)
    release(); // some hide that a key is let go
  else if (axis !== undefined) {
    // A key that cannot drive is taken as well, else viser's camera would walk.
    if (!event.repeat && (axis !== LATERAL || canGoSideways)) codes.add(event.code);
    return true;
  }
  return false;
}

/**
 * A key is let go.
 *
 * @param {KeyboardEvent} event
 */
export const lift = ({ code }) => codes.delete(code);

/** All keys are let go. */
export const release = () => codes.clear();

/** The held keys as shares of the highest speeds ahead, to the left and counter-clockwise. */
export function share() {
  const axes = [0, 0, 0];
  for (const code of codes) {
    const [axis, way] = KEYS[code];
    axes[axis] = Math.max(-1, Math.min(1, axes[axis] + way));
  }
  return axes;
}
