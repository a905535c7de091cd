// Displays in the list of commands: to select one, or to look at it.

import { act } from "webviz/act.js";
import { command } from "webviz/commands.js";
import * as selection from "webviz/panels/displays/selection.js";
import { provideFrom } from "webviz/shell/command_list.js";
import { openPanel } from "webviz/docks/layout.js";
import { toast } from "webviz/toasts.js";

const ALL = ""; // displays

export function install() {
  command({
    name: "Look at everything",
    icon: "focus",
    key: "Shift+f",
    group: "View",
    run: () => act("FocusDisplay", { display: ALL }),
  });
  // A browser would bookmark the page.
  command({
    name: "Duplicate display",
    key: "Ctrl+d",
    isHidden: true,
    group: "Displays",
    run: () => toast("Select a display to duplicate it.", { level: "warn" }),
  });
  provideFrom(["displays"], ({ displays }) =>
    (displays.get("order") ?? []).flatMap((id) => {
      const display = displays.get(id);
      if (!display) return [];
      const { name, type, icon } = display;
      const about = { icon, note: type === name ? "" : type, group: "Displays" };
      return [
        { ...about, name: `Select ${name}`, run: () => select(id) },
        { ...about, name: `Focus on ${name}`, run: () => act("FocusDisplay", { display: id }) },
      ];
    }),
  );
}

/** @param {string} id */
function select(id) {
  openPanel("displays");
  selection.reveal(id);
}
