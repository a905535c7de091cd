// Handles of displays that people move in the scene, with the tool Interact.

import { HandleGestures } from "webviz/features/handles/gesture.js";
import * as glow from "webviz/features/handles/glow.js";
import * as registry from "webviz/features/handles/registry.js";
import * as poses from "webviz/features/handles/poses.js";
import { provide, setDefault } from "webviz/tools/registry.js";

/** @import {Tool} from "webviz/types.js" */

export function install() {
  registry.install();
  poses.install();
  glow.install();
  const tool = interact();
  provide("handles", [tool]);
  setDefault(tool);
}

/** @returns {Tool} */
function interact() {
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
