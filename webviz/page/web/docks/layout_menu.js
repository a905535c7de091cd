// The saved layouts in the menu and in the list of commands.

import { act } from "../act.js";
import { el } from "../dom.js";
import { provide } from "../shell/commands.js";
import { openDialog } from "../shell/dialog.js";
import { clear, savedLayouts } from "./docks.js";
import { openWindow } from "./windows.js";

/** @import {MenuItem} from "../shell/menu.js" */

/** @returns {(MenuItem | null)[]} */
export function layoutMenu() {
  const all = savedLayouts();
  const more = all.length
    ? [
        null,
        ...all.map(({ name, is_shown }) => ({
          label: name,
          checked: is_shown,
          needs: "SetLayout",
          run: () => show(name),
        })),
        null,
        {
          label: "Open in a window",
          icon: "screen",
          items: all.map(({ name }) => ({ label: name, run: () => openWindow("layout", name) })),
        },
        {
          label: "Remove",
          icon: "trash",
          needs: "RemoveLayout",
          items: all.map(({ name }) => ({
            label: name,
            run: () => act("RemoveLayout", { name }),
          })),
        },
      ]
    : [];
  return [
    { label: "Save this layout…", icon: "plus", needs: "SaveLayout", run: save },
    { label: "All panels in the tabs", icon: "sidebar", run: clear },
    ...more,
  ];
}

export function install() {
  provide(() => [
    { name: "Save this layout…", group: "View", needs: "SaveLayout", run: save },
    { name: "All panels in the tabs", group: "View", run: clear },
    ...savedLayouts().map(({ name }) => ({
      name: `Layout: ${name}`,
      group: "View",
      needs: "SetLayout",
      run: () => show(name),
    })),
  ]);
}

/** @param {string} name */
const show = (name) => act("SetLayout", { layout: name });

async function save() {
  const taken = new Set(savedLayouts().map(({ name }) => name));
  let number = 1;
  while (taken.has(`Layout ${number}`)) number += 1;
  const field = el("input", {
    class: "wv-field",
    type: "text",
    "aria-label": "Name of the layout",
    value: savedLayouts().find(({ is_shown }) => is_shown)?.name ?? `Layout ${number}`,
    autofocus: true,
    onfocus: (/** @type {FocusEvent & {target: HTMLInputElement}} */ { target }) => target.select(),
  });
  const answer = await openDialog({
    title: "Save the layout of the panels",
    content: field,
    buttons: [
      { label: "Cancel", value: null },
      { label: "Save", value: true, primary: true },
    ],
  });
  if (answer) act("SaveLayout", { name: field.value.trim() });
}
