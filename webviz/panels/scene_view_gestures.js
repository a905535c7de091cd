// Mouse, fingers and keys over a 3D scene, as over the scene itself: left turns, middle or Shift moves,
// right and the wheel come closer; one finger turns, two move and zoom.

import { takeKeysOf } from "webviz/keys.js";
import { focused, moved, turned, zoomed } from "./scene_view_camera.js";

/** @import {Vec2} from "../page/web/types.js" */
/** @import {SceneCamera} from "./scene_view_camera.js" */

const MIDDLE = 4; // of `buttons`
const RIGHT = 2;
const STEP = 20; // pixels of an arrow key
/** @type {Record<string, Vec2>} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/**
 * Listens to a canvas; `change(how)` gets functions of its camera.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {(how: (camera: SceneCamera) => SceneCamera) => void} change
 */
export function listen(canvas, change) {
  /** @type {Map<number, Vec2>} */
  const pointers = new Map();
  /** @param {Vec2} by */
  const move = (by) => change((camera) => moved(camera, by, canvas.clientHeight));
  /** @param {PointerEvent} event */
  const release = ({ pointerId }) => pointers.delete(pointerId);

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  for (const name of /** @type {const} */ (["pointerup", "pointercancel"]))
    canvas.addEventListener(name, release);
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    /** @type {Vec2} */
    const now = [event.clientX, event.clientY];
    /** @type {Vec2} */
    const by = [now[0] - before[0], now[1] - before[1]];
    const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
    pointers.set(event.pointerId, now);
    if (other) {
      move([by[0] / 2, by[1] / 2]);
      change((camera) => zoomed(camera, apart(before, other) / apart(now, other)));
    } else if (event.buttons & RIGHT) change((camera) => zoomed(camera, 1.01 ** by[1]));
    else if (event.shiftKey || event.buttons & MIDDLE) move(by);
    else change((camera) => turned(camera, by));
  });
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const steps = event.deltaY / (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 3 : 120);
      change((camera) => zoomed(camera, (steps > 0 ? 1.12 : 1 / 0.88) ** steps));
    },
    { passive: false },
  );
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("dblclick", ({ offsetX, offsetY }) => {
    const { clientWidth, clientHeight } = canvas;
    change((camera) => focused(camera, [offsetX, offsetY], [clientWidth, clientHeight]));
  });
  takeKeysOf(canvas, (event) => {
    const arrow = ARROWS[event.key];
    const zoom = { "+": 1 / 1.12, "=": 1 / 1.12, "-": 1.12 }[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey || !(arrow || zoom)) return false;
    if (zoom) change((camera) => zoomed(camera, zoom));
    else {
      /** @type {Vec2} */
      const by = [arrow[0] * STEP, arrow[1] * STEP];
      if (event.shiftKey) move(by);
      else change((camera) => turned(camera, by));
    }
    return true;
  });
}

/**
 * The distance of two fingers, at least a pixel.
 *
 * @param {Vec2} a
 * @param {Vec2} b
 */
const apart = (a, b) => Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1]));
