// The selection of a page that was exported: what is known without its display.

/** @import {DisplayRow} from "../contents.js" */

/**
 * Returns `{select(fields), selected(), selection()}`: the command, and the stores of these names.
 *
 * @param {(display: string) => DisplayRow | undefined} rowOf
 * @param {() => string} stamp the time that is shown
 */
export function selection(rowOf, stamp) {
  /** @type {Map<number, {display: string, thing: object}>} */
  let things = new Map(); // by id
  let total = 0;

  /**
   * @param {any} picks
   * @param {any} item
   */
  function made({ group, key }, [id, number, at, color]) {
    const display = group.split("/", 1)[0];
    const row = rowOf(display);
    const name = row?.name ?? display;
    /** @type {Record<string, string>} */
    const fields = {
      Position: `${at.map((/** @type {number} */ each) => each.toFixed(4)).join(", ")} m`,
    };
    if (color) fields.Color = color.join(", ");
    if (row?.topics.length) fields.Topic = row.topics.join(", ");
    fields.Time = stamp();
    const title = number === null ? key || name : `${key || "Item"} ${number}`.trim();
    const thing = { display, name, title, tree: { fields }, note: "" };
    return { id, display, thing };
  }

  return {
    /** @param {any} fields of the command Select */
    select({ picks, keep, total: count }) {
      things = new Map([...things].filter(([id]) => keep.includes(id)));
      for (const each of picks)
        for (const item of each.items) {
          const { id, ...rest } = made(each, item);
          things.set(id, rest);
        }
      total = Math.max(count, things.size);
    },
    selected: () =>
      Object.fromEntries([...things].map(([id, { display }]) => [id, [display, false]])),
    selection() {
      const told = [...things].map(([id, { thing }]) => [id, thing]);
      const info = { total, live: things.size, count: things.size };
      return things.size ? { ...Object.fromEntries(told), "/info": info } : {};
    },
  };
}
