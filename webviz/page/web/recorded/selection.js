// The selection of a page that was exported: the recorded details of things, and what the scene has.

/** @import {DisplayRow} from "webviz/contents.js" */
/** @import {Column, NodeValues} from "webviz/recorded/types.js" */

const MISSING = "not in the file. Open the bag in webviz to see them.";

/**
 * The value of an item in a column.
 *
 * @param {Column | undefined} column
 * @param {number} number
 */
function cell(column, number) {
  if (!column) return undefined;
  if ("numbers" in column) return `${column.numbers[number]} ${column.unit}`.trim();
  return /** @type {any} */ ("all" in column ? column.all : column.each[number]);
}

/**
 * Returns `{select(fields), selected(), selection()}`: the command, and the stores of these names.
 *
 * @param {(display: string) => DisplayRow | undefined} rowOf
 * @param {(display: string, node: string) => Promise<NodeValues>} valuesOf of a node now
 * @param {() => string} stamp the time that is shown
 */
export function selection(rowOf, valuesOf, stamp) {
  /** @type {Map<number, {display: string, thing: object}>} */
  let things = new Map(); // by id
  let total = 0;

  /**
   * @param {any} picks
   * @param {any} item
   * @param {NodeValues} values
   */
  function thingOf({ group, key }, [, number, at, color], values) {
    const display = group.split("/", 1)[0];
    const row = rowOf(display);
    const name = row?.name ?? display;
    /** @type {Record<string, any>} */
    const fields = {};
    const isKnown = values.has("#titles");
    for (const [field, column] of values) {
      const value = field.startsWith(".") ? cell(column, number ?? 0) : null;
      if (value !== undefined && value !== null) fields[field.slice(1)] = value;
    }
    // Large clouds and maps are moved: places in them mean nothing without their values.
    if (isKnown)
      fields.Position = `${at.map((/** @type {number} */ each) => each.toFixed(4)).join(", ")} m`;
    if (values.get("#frame")) fields.Frame = values.get("#frame");
    if (color) fields.Color = color.join(", ");
    if (row?.topics.length) fields.Topic = row.topics.join(", ");
    if (values.get("#stamp")) fields.Stamp = values.get("#stamp");
    fields.Time = stamp();
    if (!isKnown) fields.Values = MISSING;
    const plain = number === null ? key || name : `${key || "Item"} ${number}`.trim();
    const title = cell(values.get("#titles"), number ?? 0) ?? plain;
    const thing = { display, name, title, tree: { fields }, note: "" };
    return { display, thing };
  }

  return {
    /** @param {any} fields of the command Select */
    async select({ picks, keep, total: count }) {
      const next = new Map([...things].filter(([id]) => keep.includes(id)));
      for (const each of picks) {
        const display = each.group.split("/", 1)[0];
        const values = await valuesOf(display, `${each.group}\n${each.key}\n`);
        for (const item of each.items) next.set(item[0], thingOf(each, item, values));
      }
      things = next;
      total = Math.max(count, things.size);
    },
    selected: () =>
      Object.fromEntries([...things].map(([id, { display }]) => [id, [display, false]])),
    selection() {
      const entries = [...things].map(([id, { thing }]) => [id, thing]);
      const info = { total, live: things.size, count: things.size };
      return things.size ? { ...Object.fromEntries(entries), "/info": info } : {};
    },
  };
}
