// Menus of views: their types, and those that were saved.

import { act } from "../act.js";
import { el } from "../dom.js";
import { ask, openDialog } from "./dialog.js";

/** @import {MenuItem} from "./menu.js" */

export const VIEW_TYPES = ["Orbit", "XYOrbit", "ThirdPersonFollower", "FPS", "TopDownOrtho"];

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
  const numbers = Array.from({ length: saved().length + 1 }, (_, index) => `View ${index + 1}`);
  const input = el("input", {
    class: "wv-field",
    type: "text",
    "aria-label": "Name",
    autofocus: true,
  });
  input.value = numbers.find((name) => !saved().includes(name)) ?? "";
  input.select();
  const accept = async () => {
    const name = input.value.trim();
    return (
      name !== "" &&
      (!saved().includes(name) || ask(`Replace the view ${name}?`, { confirm: "Replace" }))
    );
  };
  const buttons = [
    { label: "Cancel", value: null },
    { label: "Save", value: true, primary: true, accept },
  ];
  if (await openDialog({ title: "Save this view", content: input, buttons })) {
    act("SaveView", { name: input.value.trim() });
  }
}
