// Where displays can go: `{group, before}`, ids as of the command MoveDisplay.

import { isWithin, siblings, topmost } from "./model.js";

/** The place at the end of a group. */
export const inside = (group) => ({ group: group.id, before: "", depth: group.depth + 1 });

/**
 * The place below a row, next to a certain depth of those that are possible there.
 *
 * `rows` are what is shown, `index` is of the row, -1 for above all; `moved` the ids of what goes there.
 */
export function below(model, rows, index, depth, moved, isOpen) {
  const stays = (item) => !isWithin(item, moved);
  const upper = rows.slice(0, index + 1).findLast(stays);
  const lower = rows.slice(index + 1).find(stays);
  const most = upper ? upper.depth + (upper.isGroup && isOpen(upper) ? 1 : 0) : 0;
  const least = Math.min(lower?.depth ?? 0, most);
  const wanted = Math.max(least, Math.min(depth, most));
  if (!upper) return { group: "", before: model.top.find(stays)?.id ?? "", depth: 0 };
  if (wanted > upper.depth) {
    return { group: upper.id, before: upper.children.find(stays)?.id ?? "", depth: wanted };
  }
  let item = upper;
  while (item.depth > wanted) item = item.parent;
  return { ...behind(model, item, moved), depth: wanted };
}

/** Places that keys move to, null where there is no way: "up", "down", "out" of a group, "into" one. */
export function step(model, ids, way) {
  const moved = topmost(model, ids);
  if (!moved.length) return null;
  const [first, last] = [moved[0], moved.at(-1)];
  const around = siblings(model, first);
  const before = around.slice(0, around.indexOf(first));
  if (way === "up") {
    return before.length ? { group: first.parent?.id ?? "", before: before.at(-1).id } : null;
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

/** The commands that bring displays to a place, in order; none for those that are there already. */
export function moves(model, ids, { group, before }) {
  const moved = topmost(model, ids);
  const around = group ? model.byId.get(group).children : model.top;
  const at = around.indexOf(moved[0]);
  const next = around[at + moved.length]?.id ?? "";
  const isThere = at >= 0 && next === before && moved.every((item, i) => around[at + i] === item);
  return isThere ? [] : moved.map(({ id }) => ({ display: id, group, before }));
}

function behind(model, item, moved) {
  const around = siblings(model, item);
  const next = around.slice(around.indexOf(item) + 1).find(({ id }) => !moved.has(id));
  return { group: item.parent?.id ?? "", before: next?.id ?? "" };
}
