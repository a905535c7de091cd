// The menu of the types of views.

import { act } from "webviz/act.js";

/** @import {MenuItem} from "webviz/controls/menu.js" */

export const VIEW_TYPES = [
  "Orbit",
  "XYOrbit",
  "ThirdPersonFollower",
  "FPS",
  "FrameAligned",
  "TopDownOrtho",
];

/** @param {string} value */
export const setType = (value) => act("ChangeView", { key: "type", value });

/**
 * The types of views, with a mark at that of this page.
 *
 * @param {string} type
 * @returns {(MenuItem | null)[]}
 */
export const typeMenu = (type) => [
  ...VIEW_TYPES.map((name) => ({
    label: name,
    checked: type === name,
    run: () => setType(name),
  })),
  null,
  { label: "Zero", icon: "reset", key: "z", run: () => act("ResetView") },
];
