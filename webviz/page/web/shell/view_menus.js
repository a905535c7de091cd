// Menus of views: their types, and those that were saved.

import { act } from "../act.js";
import { ask, askName } from "../controls/dialog.js";

/** @import {MenuItem} from "../controls/menu.js" */

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

/**
 * The saved views, and commands for this one.
 *
 * @param {() => string[]} saved
 * @returns {(MenuItem | null)[]}
 */
export const savedMenu = (saved) => [
  ...saved().map((name) => ({
    label: name,
    icon: "eye",
    run: () => act("ShowView", { view: name }),
  })),
  ...(saved().length ? [null] : []),
  { label: "Save this view…", icon: "save", needs: "SaveView", run: () => saveView(saved) },
  {
    label: "Start with this view",
    icon: "play",
    needs: "StartWithView",
    run: () => act("StartWithView"),
  },
];

/**
 * Asks for the name of a view, and saves it.
 *
 * @param {() => string[]} saved names that there are
 */
export async function saveView(saved) {
  const name = await askName("view", {
    title: "Save this view",
    confirm: "Save",
    taken: saved(),
    accept: (name) =>
      name !== "" &&
      (!saved().includes(name) || ask(`Replace the view ${name}?`, { confirm: "Replace" })),
  });
  if (name !== null) act("SaveView", { name });
}
