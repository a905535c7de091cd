// The tools that move the camera, and aim it.

import { focusOn } from "webviz/scene/mouse.js";
import { clicks } from "webviz/tools/clicks.js";
import { select } from "webviz/tools/registry.js";

/** @import {Tool} from "webviz/types.js" */

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
