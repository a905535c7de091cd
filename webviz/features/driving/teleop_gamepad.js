// The sticks of a gamepad: the left one drives, the right one goes sideways.

const DEAD = 0.15; // of a stick that does not quite come back to its middle
const [LEFT_X, LEFT_Y, RIGHT_X] = [0, 1, 2];

/** The sticks: each counts once all have been in their middle, so that no robot drives off. */
export function makeGamepad() {
  let isArmed = false;
  return {
    /** Lets the sticks count only once they have been in their middle again. */
    disarm: () => void (isArmed = false),
    /** The held sticks, as `share` of teleop_keys.js. */
    share() {
      const shares = sticks();
      isArmed ||= shares.every((part) => part === 0);
      return isArmed ? shares : [0, 0, 0];
    },
  };
}

function sticks() {
  const pads = [...(navigator.getGamepads?.() ?? [])];
  const axes = pads.find((pad) => pad?.connected && pad.axes.length > LEFT_Y)?.axes ?? [];
  return [LEFT_Y, RIGHT_X, LEFT_X].map((axis) => alive(-(axes[axis] ?? 0)));
}

/** @param {number} value */
function alive(value) {
  const size = (Math.min(1, Math.abs(value)) - DEAD) / (1 - DEAD);
  return size > 0 ? Math.sign(value) * size : 0;
}
