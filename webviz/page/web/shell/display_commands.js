// Displays in the list of commands: to select one, or to look at it.

import { act } from "../act.js";
import * as selection from "../panels/displays/selection.js";
import { provideFrom } from "./command_list.js";
import { openPanel } from "../docks/layout.js";

export function install() {
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
