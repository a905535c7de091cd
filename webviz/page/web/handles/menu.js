// The menu of a handle.

import { openMenu } from "../shell/menu.js";

/** Opens the menu of a handle at a place of the window; `choose(id)` gets the chosen entry. */
export const open = ([x, y], handle, choose) => openMenu(x, y, itemsOf(handle.menu, choose));

const itemsOf = (entries, choose) =>
  entries.map(({ id, title, checked, refusal, entries: below }) => ({
    label: title || " ",
    checked: checked ?? undefined,
    disabled: Boolean(refusal),
    tip: refusal,
    items: below.length ? itemsOf(below, choose) : undefined,
    needs: "GripHandle",
    run: () => choose(id),
  }));
