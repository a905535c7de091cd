// Actions on displays, and their menu.

import { act, newStep } from "webviz/act.js";
import { copyAndTell } from "webviz/clipboard.js";
import { openMenu } from "webviz/controls/menu.js";
import { setOpen } from "webviz/panels/displays/folding.js";
import { siblings, topmost } from "webviz/panels/displays/model.js";
import { moves, step } from "webviz/panels/displays/places.js";
import * as selection from "webviz/panels/displays/selection.js";

/** @import {Commands} from "webviz/messages.js" */
/** @import {Item, Model, Place, Way} from "webviz/panels/displays/types.js" */

/** @type {Map<string, boolean>} */
const switching = new Map();

/**
 * True if a display is on: as it was just switched here, until the viewer has answered.
 *
 * @param {Item} item
 */
export const isEnabled = (item) => switching.get(item.id) ?? item.enabled;

/**
 * Switches displays on or off; `refresh` shows what came of it.
 *
 * @param {Item[]} items
 * @param {boolean} value
 * @param {() => void} refresh
 */
export async function setEnabled(items, value, refresh) {
  for (const { id } of items) switching.set(id, value);
  refresh();
  await each("SetProperty", items, { path: "enabled", value });
  for (const { id } of items) switching.delete(id);
  refresh();
}

/** @param {Item} item */
export const focus = (item) => act("FocusDisplay", { display: item.id });

/** @param {Item[]} items */
export const duplicate = (items) => each("DuplicateDisplay", items, {});

/** @param {Item[]} items */
export const reset = (items) => each("ResetDisplay", items, {});

/**
 * Sends a command for each display; one step for undo.
 *
 * @template {"SetProperty" | "DuplicateDisplay" | "ResetDisplay" | "RemoveDisplay"} C
 * @param {C} command
 * @param {Item[]} items
 * @param {Omit<Commands[C], "display">} fields
 */
function each(command, items, fields) {
  const step = newStep();
  return Promise.all(
    items.map(({ id }) => {
      const whole = /** @type {Commands[C]} */ ({ display: id, ...fields });
      return act(command, whole, { step });
    }),
  );
}

/**
 * Removes displays; the row that follows them, or else the one before, is selected then.
 *
 * @param {Model} model
 * @param {Item[]} rows
 * @param {Item[]} items
 */
export function remove(model, rows, items) {
  const ids = new Set(items.map(({ id }) => id));
  /** @param {Item} row */
  const stays = (row) => model.byId.has(row.id) && !goes(row);
  /**
   * @param {Item | null} row
   * @returns {boolean}
   */
  const goes = (row) => row !== null && (ids.has(row.id) || goes(row.parent));
  const last = rows.findLastIndex(goes);
  selection.leaveTo(
    (rows.slice(last + 1).find(stays) ?? rows.slice(0, last).findLast(stays))?.id ?? null,
  );
  each("RemoveDisplay", items, {});
}

/**
 * Copies displays as a config file has them.
 *
 * @param {Item[]} items
 */
export async function copyAsYaml(items) {
  const { level, text } = await act(
    "WriteDisplays",
    { displays: items.map(({ id }) => id) },
    { quiet: true },
  );
  if (level === "error") return;
  const what = items.length === 1 ? items[0].name : `${items.length} displays`;
  copyAndTell(text, `Copied ${what} as YAML.`);
}

/**
 * Brings displays to a place, and unfolds the group that they go into.
 *
 * @param {Model} model
 * @param {Set<string>} ids
 * @param {Place | null} place
 */
export function move(model, ids, place) {
  if (!place) return;
  const group = model.byId.get(place.group);
  if (group) setOpen(group, true);
  const step = newStep();
  for (const fields of moves(model, ids, place)) act("MoveDisplay", fields, { step });
}

/**
 * @param {Model} model
 * @param {Set<string>} ids
 * @param {Way} way
 */
export const moveBy = (model, ids, way) => move(model, ids, step(model, ids, way));

/**
 * Puts displays into a new group, where the first of them is; resolves with the id of it.
 *
 * @param {Model} model
 * @param {Item[]} items
 */
export async function group(model, items) {
  const [first] = items;
  const parent = first.parent?.id ?? "";
  const around = siblings(model, first);
  const next = around.slice(around.indexOf(first)).find((item) => !items.includes(item));
  const step = newStep();
  const { level, display } = await act("AddDisplay", { type: "Group", group: parent }, { step });
  if (level === "error") return null;
  for (const { id } of items) act("MoveDisplay", { display: id, group: display }, { step });
  if (next) act("MoveDisplay", { display, group: parent, before: next.id }, { step });
  return display;
}

/**
 * Opens the menu of the selected displays at a place of the window.
 *
 * @param {number} x
 * @param {number} y
 * @param {{model: Model, rows: () => Item[], rename: (id: string | null) => void, refresh: () => void}} tree
 */
export function openActions(x, y, { model, rows, rename, refresh }) {
  const items = topmost(model, selection.ids());
  const [first] = items;
  if (!first) return;
  const isOne = items.length === 1;
  const canEdit = items.every((item) => item.can_edit);
  openMenu(x, y, [
    { label: "Focus", icon: "focus", disabled: !isOne, run: () => focus(first) },
    {
      label: "Rename",
      icon: "pencil",
      key: "F2",
      needs: "SetProperty",
      disabled: !isOne || !first.can_edit,
      run: () => rename(first.id),
    },
    { label: "Duplicate", icon: "copy", needs: "DuplicateDisplay", run: () => duplicate(items) },
    { label: "Copy as YAML", icon: "file", key: "Ctrl+c", run: () => copyAsYaml(items) },
    {
      label: "Put into a new group",
      icon: "folder",
      needs: "AddDisplay",
      run: async () => rename(await group(model, items)),
    },
    {
      label: "Reset to defaults",
      icon: "reset",
      needs: "ResetDisplay",
      run: () => reset(items),
      disabled: !canEdit || items.every((item) => item.isGroup),
    },
    null,
    {
      label: "Remove",
      icon: "trash",
      key: "Delete",
      danger: true,
      needs: "RemoveDisplay",
      run: () => {
        remove(model, rows(), items);
        refresh();
      },
    },
  ]);
}
