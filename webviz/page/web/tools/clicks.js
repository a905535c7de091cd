// Clicks among the pointer's events; drags stay with the camera.

/** @import {SceneEvent, Vec2} from "webviz/types.js" */

const CLICK_PX = 4;

/**
 * Makes `pointer` of a tool that acts on clicks of the left button, `onClick(event)`, of the right
 * one, `onRight`, and on what moves without a button, `onMove`.
 *
 * @param {(event: PointerEvent) => void} onClick
 * @param {(event: PointerEvent) => void} onRight
 * @param {(event: PointerEvent) => void} onMove
 */
export function clicks(onClick, onRight = () => {}, onMove = () => {}) {
  /** @type {{pointer: number, at: Vec2} | null} */
  let pressed = null;
  return (/** @type {SceneEvent} */ event) => {
    if ("deltaY" in event) return false;
    if (event.type === "pointerdown") {
      pressed = { pointer: event.pointerId, at: [event.clientX, event.clientY] };
    } else if (event.type === "pointercancel") {
      pressed = null;
    } else if (event.type === "pointermove") {
      if (isFar(event)) pressed = null;
      if (event.buttons === 0) onMove(event);
    } else if (event.type === "pointerup" && pressed?.pointer === event.pointerId) {
      const isClick = !isFar(event);
      pressed = null;
      if (isClick && event.button === 0) onClick(event);
      if (isClick && event.button === 2) onRight(event);
    }
    return false;
  };

  /** @param {PointerEvent} event */
  function isFar({ pointerId, clientX, clientY }) {
    if (pressed?.pointer !== pointerId) return false;
    return Math.hypot(clientX - pressed.at[0], clientY - pressed.at[1]) >= CLICK_PX;
  }
}
