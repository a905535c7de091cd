// The saved layouts in the menu and in the list of commands.

import { act } from "webviz/act.js";
import { clear, savedLayouts, templates } from "webviz/docks/docks.js";
import { openWindow } from "webviz/docks/windows.js";
import { submenu } from "webviz/shell/actions.js";
import { provide } from "webviz/commands.js";
import { askName } from "webviz/controls/dialog.js";

/** @import {MenuItem} from "webviz/controls/menu.js" */

/** @type {Record<string, string>} */
const ICONS = { Navigate: "flag", Tune: "gear", "Debug a bag": "search" };

/** @returns {(MenuItem | null)[]} */
function menu() {
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
    null,
    ...templates.value.map((name) => ({
      label: name,
      icon: ICONS[name],
      needs: "UseTemplate",
      tip: "Adds the panels that it needs",
      run: () => useTemplate(name),
    })),
    ...more,
  ];
}

export function install() {
  submenu("Layout", "sidebar", menu);
  provide(() => [
    { name: "Save this layout…", group: "View", needs: "SaveLayout", run: save },
    { name: "All panels in the tabs", group: "View", run: clear },
    ...templates.value.map((name) => ({
      name: `Layout for a task: ${name}`,
      icon: ICONS[name],
      group: "View",
      needs: "UseTemplate",
      run: () => useTemplate(name),
    })),
    ...savedLayouts().map(({ name }) => ({
      name: `Layout: ${name}`,
      group: "View",
      needs: "SetLayout",
      run: () => show(name),
    })),
  ]);
}

/** @param {string} template */
const useTemplate = (template) => act("UseTemplate", { template });

/** @param {string} name */
const show = (name) => act("SetLayout", { layout: name });

async function save() {
  const saved = savedLayouts();
  const name = await askName("layout", {
    title: "Save the layout of the panels",
    confirm: "Save",
    usedNames: saved.map((each) => each.name),
    value: saved.find(({ is_shown }) => is_shown)?.name,
  });
  if (name !== null) act("SaveLayout", { name });
}
