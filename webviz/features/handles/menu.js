// The menu of a handle.

import { openMenu } from "webviz/controls/menu.js";

/** @import {HandleMenuEntry, SceneHandle} from "webviz/contents.js" */
/** @import {MenuItem} from "webviz/controls/menu.js" */
/** @import {Vec2} from "webviz/types.js" */

/**
 * Opens the menu of a handle at a place of the window; `choose(id)` gets the chosen entry.
 *
 * @param {Vec2} at
 * @param {SceneHandle} handle
 * @param {(id: number) => unknown} choose
 */
export const open = ([x, y], handle, choose) => openMenu(x, y, itemsOf(handle.menu, choose));

/**
 * @param {HandleMenuEntry[]} entries
 * @param {(id: number) => unknown} choose
 * @returns {MenuItem[]}
 */
const itemsOf = (entries, choose) =>
  entries.map(({ id, title, checked, refusal, entries: below }) => ({
    label: title || " ",
    checked: checked ?? undefined,
    disabled: Boolean(refusal),
    tip: refusal,
    items: below.length ? itemsOf(below, choose) : undefined,
    needs: "DragHandle",
    run: () => choose(id),
  }));
