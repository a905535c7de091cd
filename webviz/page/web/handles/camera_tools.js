// The tools that leave the pointer to the camera, and the one that aims the camera.

import { HandleGestures } from "webviz/handles/gesture.js";
import { focusOn } from "webviz/scene/mouse.js";
import { clicks } from "webviz/tools/clicks.js";
import { select } from "webviz/tools/registry.js";

/** @import {Tool} from "webviz/types.js" */

/**
 * The tool that moves handles.
 *
 * @returns {Tool}
 */
export function interact() {
  const gestures = new HandleGestures();
  return {
    id: "interact",
    name: "Interact",
    shortcut: "i",
    icon: "hand",
    order: 0,
    isLean: true,
    tooltip: "Interact with objects, and move the camera elsewhere.",
    hint: "",
    pointer: (event) => gestures.pointer(event),
    leave: () => gestures.leave(),
  };
}

/** @type {Tool} */
export const moveCamera = {
  id: "move-camera",
  name: "Move Camera",
  shortcut: "m",
  icon: "move",
  order: 1,
  isLean: true,
  tooltip: "Move the camera, whatever the pointer is on.",
  hint: "",
  cursor: "move",
};

/** @type {Tool} */
export const focusCamera = {
  id: "focus-camera",
  name: "Focus Camera",
  shortcut: "c",
  icon: "focus",
  order: 3,
  isLean: true,
  tooltip: "Let the camera look at a point: click on it.",
  hint: "Click on a point to look at it. Esc cancels.",
  cursor: "crosshair",
  pointer: clicks((event) => {
    focusOn([event.clientX, event.clientY]);
    select(null);
  }),
};
