// The saved views in the toolbar and in the list of commands.

import { act } from "webviz/act.js";
import { command } from "webviz/commands.js";
import { ask, askName } from "webviz/controls/dialog.js";
import { provideFrom } from "webviz/shell/command_list.js";
import { barMenu } from "webviz/shell/toolbar.js";
import { store } from "webviz/stores.js";

/** @import {MenuItem} from "webviz/controls/menu.js" */

const settings = store("settings");
const saved = () => settings.get("views") ?? [];

export function addMenu() {
  barMenu("bookmark", "Saved views", menu);
  command({ name: "Save view…", icon: "save", group: "View", needs: "SaveView", run: save });
  provideFrom([], () =>
    saved().map((name) => ({
      name: `Show view ${name}`,
      icon: "eye",
      group: "Saved views",
      run: () => act("ShowView", { view: name }),
    })),
  );
}

/**
 * The saved views, and commands for this one.
 *
 * @returns {(MenuItem | null)[]}
 */
const menu = () => [
  ...saved().map((name) => ({
    label: name,
    icon: "eye",
    run: () => act("ShowView", { view: name }),
  })),
  ...(saved().length ? [null] : []),
  { label: "Save this view…", icon: "save", needs: "SaveView", run: save },
  {
    label: "Start with this view",
    icon: "play",
    needs: "StartWithView",
    run: () => act("StartWithView"),
  },
];

/** Asks for the name of a view, and saves it. */
async function save() {
  const name = await askName("view", {
    title: "Save this view",
    confirm: "Save",
    usedNames: saved(),
    accept: (name) =>
      name !== "" &&
      (!saved().includes(name) || ask(`Replace the view ${name}?`, { confirm: "Replace" })),
  });
  if (name !== null) act("SaveView", { name });
}
