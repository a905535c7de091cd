// Places to which displays can go: `{group, before}`, ids as of the command MoveDisplay.

import { isWithin, siblings, topmost } from "webviz/panels/displays/model.js";

/** @import {Item, Model, Place, Way} from "webviz/panels/displays/types.js" */

/**
 * The place at the end of a group.
 *
 * @param {Item} group
 */
export const inside = (group) => ({ group: group.id, before: "", depth: group.depth + 1 });

/**
 * The place below a row, next to a certain depth of those that are possible there.
 *
 * `rows` are what is shown, `index` is of the row, -1 for above all; `moved` the ids of what goes there.
 *
 * @param {Model} model
 * @param {Item[]} rows
 * @param {number} index
 * @param {number} depth
 * @param {Set<string>} moved
 * @param {(item: Item) => boolean} isOpen
 */
export function below(model, rows, index, depth, moved, isOpen) {
  /** @param {Item} item */
  const stays = (item) => !isWithin(item, moved);
  const upper = rows.slice(0, index + 1).findLast(stays);
  const lower = rows.slice(index + 1).find(stays);
  const most = upper ? upper.depth + (upper.isGroup && isOpen(upper) ? 1 : 0) : 0;
  const least = Math.min(lower?.depth ?? 0, most);
  const level = Math.max(least, Math.min(depth, most));
  if (!upper) return { group: "", before: model.top.find(stays)?.id ?? "", depth: 0 };
  if (level > upper.depth) {
    return { group: upper.id, before: upper.children.find(stays)?.id ?? "", depth: level };
  }
  let item = upper;
  while (item.parent && item.depth > level) item = item.parent;
  return { ...behind(model, item, moved), depth: level };
}

/**
 * Places that keys move to, null where there is no way: "up", "down", "out" of a group, "into" one.
 *
 * @param {Model} model
 * @param {Set<string>} ids
 * @param {Way} way
 * @returns {Place | null}
 */
export function step(model, ids, way) {
  const moved = topmost(model, ids);
  if (!moved.length) return null;
  const [first, last] = [moved[0], moved[moved.length - 1]];
  const around = siblings(model, first);
  const before = around.slice(0, around.indexOf(first));
  if (way === "up") {
    const upper = before.at(-1);
    return upper ? { group: first.parent?.id ?? "", before: upper.id } : null;
  }
  if (way === "out") return first.parent && behind(model, first.parent, ids);
  if (way === "into") {
    const group = before.findLast(({ isGroup }) => isGroup);
    return group ? inside(group) : null;
  }
  const others = siblings(model, last);
  const next = others[others.indexOf(last) + 1];
  return next ? behind(model, next, ids) : null;
}

/**
 * The commands that bring displays to a place, in order; none for those that are there already, or
 * if the group is gone.
 *
 * @param {Model} model
 * @param {Set<string>} ids
 * @param {Place} place
 */
export function moves(model, ids, { group, before }) {
  const moved = topmost(model, ids);
  const around = group ? model.byId.get(group)?.children : model.top;
  if (!around) return []; // the group was removed meanwhile
  const at = around.indexOf(moved[0]);
  const next = around[at + moved.length]?.id ?? "";
  const isThere = at >= 0 && next === before && moved.every((item, i) => around[at + i] === item);
  return isThere ? [] : moved.map(({ id }) => ({ display: id, group, before }));
}

/**
 * @param {Model} model
 * @param {Item} item
 * @param {Set<string>} moved
 */
function behind(model, item, moved) {
  const around = siblings(model, item);
  const next = around.slice(around.indexOf(item) + 1).find(({ id }) => !moved.has(id));
  return { group: item.parent?.id ?? "", before: next?.id ?? "" };
}
