// Shows a recorded run at a time, to viser's page and to whoever watches stores and pictures.

import { bufferOf, chunks, revived } from "./chunks.js";
import { COLUMNS } from "./columns.js";
import { frameAt, lastUpTo, shownAt } from "./moments.js";
import { changesBetween } from "./scene_changes.js";
import { switches } from "./switches.js";

/** @import {ViserMessage} from "../types.js" */
/** @import {About, Chunk, ChunkIndex, Known, Shown} from "./types.js" */

/**
 * @typedef {{
 *   scene(messages: ViserMessage[]): void,
 *   store(name: string, all: boolean, set: Record<string, unknown>, gone: string[]): void,
 *   pictures(display: string, make: (() => ArrayBuffer)[]): void,
 * }} Sinks
 */

const ROWS = "displays";

/** @type {Shown} */
const NOTHING = { ros: 0, scene: new Set(), stores: new Map(), panes: new Map() };

/**
 * A message as viser's page expects it.
 *
 * @param {Chunk} chunk
 * @param {number} number
 * @returns {ViserMessage}
 */
const made = (chunk, number) =>
  revived(chunk, chunk.messages.items[number - chunk.messages.first][3]);

/**
 * @param {Chunk} chunk
 * @param {number} number
 */
function valueIn({ values: { first, items, places, shared } }, number) {
  const item = /** @type {any} */ (items[places[number - first]]);
  if (!item?.__each) return item;
  return { each: item.__each.map((/** @type {number} */ one) => shared[one]) };
}

/**
 * Returns `{show(at), ros(), watch(store), unwatch(store), enable(display, enabled), repeat(display)}`.
 *
 * @param {About} about
 * @param {Sinks} sinks
 */
export function player(about, sinks) {
  const { index } = about;
  const { load, at: unpacked } = chunks();
  let shown = NOTHING;
  let place = ""; // the chunk and the frame that are shown
  /** @type {Map<number, Known>} */
  let known = new Map(); // of the scene
  /** @type {Map<string, Map<string, unknown>>} */
  const values = new Map(); // of the stores that are shown, by key
  /** @type {Set<string>} */
  const watched = new Set();
  const switched = switches();

  /**
   * The number of the chunk that has a message, value or picture.
   *
   * @param {"message" | "value" | "picture"} kind
   * @param {number} number
   */
  const home = (kind, number) =>
    lastUpTo(index, (/** @type {ChunkIndex} */ each) => each[kind], number);

  /**
   * The chunks that have all of some messages, values or pictures.
   *
   * @param {"message" | "value" | "picture"} kind
   * @param {Iterable<number>} numbers
   * @returns {Promise<(number: number) => Chunk>}
   */
  async function homes(kind, numbers) {
    /** @type {Map<number, Chunk>} */
    const found = new Map();
    for (const number of numbers) {
      const chunk = home(kind, number);
      if (!found.has(chunk)) found.set(chunk, unpacked(chunk) ?? (await load(chunk)));
    }
    return (number) => /** @type {Chunk} */ (found.get(home(kind, number)));
  }

  /** @param {Shown} next */
  async function sceneMessages(next) {
    const fresh = [...next.scene].filter((number) => !known.has(number));
    const of = await homes("message", fresh);
    /** @type {Map<number, Known>} */
    const all = new Map();
    for (const number of [...next.scene].sort((a, b) => a - b)) {
      let message = known.get(number);
      if (!message) {
        const { first, items } = of(number).messages;
        const [key, node, phase] = items[number - first];
        message = { number, key, node, phase };
      }
      all.set(number, message);
    }
    const { gone, wanted } = changesBetween(known.values(), all.values());
    const from = await homes("message", wanted);
    const removals = gone.map((name) => ({ type: "RemoveSceneNodeMessage", name, owner: "" }));
    const messages = wanted.map((number) => made(from(number), number));
    return { all, messages: [...removals, ...messages] };
  }

  /**
   * The values of the watched stores.
   *
   * @param {Shown} next
   * @param {Iterable<string>} names
   */
  async function storeValues(next, names) {
    const wanted = [...names].map((name) => [name, next.stores.get(name) ?? new Map()]);
    const numbers = wanted.flatMap(([, content]) => [
      .../** @type {Map<string, number>} */ (content).values(),
    ]);
    const of = await homes("value", new Set(numbers));
    /** @param {number} number */
    const value = (number) => valueIn(of(number), number);
    return new Map(
      wanted.map(([name, content]) => [
        /** @type {string} */ (name),
        new Map(
          [.../** @type {Map<string, number>} */ (content)].map(([key, number]) => [
            key,
            value(number),
          ]),
        ),
      ]),
    );
  }

  /**
   * Shows the stores of these names as they are now.
   *
   * @param {Map<string, Map<string, unknown>>} next
   */
  function showStores(next) {
    // The rows of displays come first: by them is known what is hidden.
    const rows = next.get(ROWS);
    const all = rows ? [[ROWS, rows], ...[...next].filter(([name]) => name !== ROWS)] : [...next];
    for (const [name, recorded] of /** @type {[string, Map<string, unknown>][]} */ (all)) {
      const content = switched.content(name, recorded);
      const before = values.get(name);
      values.set(name, content);
      if (!before) {
        sinks.store(name, true, Object.fromEntries(content), []);
        continue;
      }
      const set = [...content].filter(([key, value]) => before.get(key) !== value);
      const gone = [...before.keys()].filter((key) => !content.has(key));
      if (set.length || gone.length) sinks.store(name, false, Object.fromEntries(set), gone);
    }
  }

  /**
   * @param {Shown} next
   * @param {string} display
   */
  async function showPicture(next, display) {
    const numbers = next.panes.get(display) ?? [];
    const of = await homes("picture", numbers);
    const makers = numbers.map((number) => () => {
      const chunk = of(number);
      return bufferOf(chunk, chunk.pictures.items[number - chunk.pictures.first]);
    });
    sinks.pictures(display, makers);
  }

  /**
   * Shows a time in seconds; the next one can be asked for when this is done.
   *
   * @param {number} at
   */
  async function show(at) {
    const [number, frame] = frameAt(index, at);
    if (place === `${number}.${frame}`) return;
    const next = shownAt(unpacked(number) ?? (await load(number)), frame);
    const { all, messages } = await sceneMessages(next);
    const stores = await storeValues(next, watched);
    const before = shown;
    [shown, place, known] = [next, `${number}.${frame}`, all];
    sinks.scene(switched.messages(messages));
    showStores(stores);
    for (const display of new Set([...before.panes.keys(), ...next.panes.keys()])) {
      const isSame = before.panes.get(display)?.join() === next.panes.get(display)?.join();
      if (!isSame) await showPicture(next, display);
    }
    if (number + 1 < index.length) load(number + 1);
  }

  return {
    show,
    /** The ROS time of the frame that is shown. */
    ros: () => shown.ros,
    /**
     * A value of a store that the page watches.
     *
     * @param {string} store
     * @param {string} key
     */
    value: (store, key) => /** @type {any} */ (values.get(store)?.get(key)),
    /**
     * The values of a store whose keys begin with a text, by the rest of their keys.
     *
     * @param {string} store
     * @param {string} start
     */
    async read(store, start) {
      const all = [...(shown.stores.get(store) ?? [])].filter(([key]) => key.startsWith(start));
      const of = await homes(
        "value",
        all.map(([, number]) => number),
      );
      return new Map(
        all.map(([key, number]) => {
          const [what, chunk] = [key.slice(start.length), of(number)];
          const value = valueIn(chunk, number);
          return [what, what === COLUMNS ? revived(chunk, value) : value];
        }),
      );
    },
    /**
     * The picture that was sent last for a node, of those whose name is wanted; null for none.
     *
     * @param {(name: string) => boolean} isWanted
     * @returns {Promise<Uint8Array | null>}
     */
    async picture(isWanted) {
      const numbers = [...known.values()].filter((one) => isWanted(one.node));
      const of = await homes(
        "message",
        numbers.map(({ number }) => number),
      );
      for (const { number } of numbers.reverse()) {
        const message = made(of(number), number);
        const data = message.updates?._data ?? message.props?._data;
        if (data) return data;
      }
      return null;
    },
    /**
     * The ids of a display and of those in it, if it is a group.
     *
     * @param {string} display
     */
    within(display) {
      const rows = values.get(ROWS) ?? new Map();
      /** @type {string[]} */
      const order = rows.get("order") ?? [];
      const first = order.indexOf(display);
      const depth = rows.get(display)?.depth ?? 0;
      const end = order.findIndex((id, at) => at > first && rows.get(id).depth <= depth);
      return order.slice(first, end < 0 ? undefined : end);
    },
    /** @param {string} name */
    async watch(name) {
      watched.add(name);
      values.delete(name);
      if (place) showStores(await storeValues(shown, [name]));
    },
    /** @param {string} name */
    unwatch(name) {
      watched.delete(name);
      values.delete(name);
    },
    /**
     * Switches a display on or off.
     *
     * @param {string} display
     * @param {boolean} enabled
     */
    async enable(display, enabled) {
      const problem = switched.set(display, enabled);
      if (problem) throw new Error(problem);
      const { messages, numbers } = switched.difference(known.values());
      const of = await homes("message", numbers);
      const recorded = numbers.map((number) => made(of(number), number));
      sinks.scene([...messages, ...recorded]);
      showStores(await storeValues(shown, watched));
    },
    /** @param {string} display */
    repeat: (display) => showPicture(shown, display),
  };
}
