// Shows a recorded run at a time, to viser's page and to whoever watches stores and pictures.

import { archive } from "webviz/recorded/archive.js";
import { frameAt, shownAt, within } from "webviz/recorded/moments.js";
import { changesBetween } from "webviz/recorded/scene_changes.js";
import { switches } from "webviz/recorded/switches.js";

/** @import {ViserMessage} from "webviz/types.js" */
/** @import {About, Known, Shown} from "webviz/recorded/types.js" */

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
 * Returns `{show(at), ros(), watch(store), unwatch(store), enable(display, enabled), repeat(display)}`, and
 * what reads the moment that is shown.
 *
 * @param {About} about
 * @param {Sinks} sinks
 */
export function player(about, sinks) {
  const { index } = about;
  const run = archive(index);
  let shown = NOTHING;
  let place = ""; // the chunk and the frame that are shown
  /** @type {Map<number, Known>} */
  let known = new Map(); // of the scene
  /** @type {Map<string, Map<string, unknown>>} */
  const values = new Map(); // of the stores that are shown, by key
  /** @type {Set<string>} */
  const watched = new Set();
  const switched = switches();

  /** @param {Shown} next */
  async function sceneMessages(next) {
    const numbers = [...next.scene].sort((a, b) => a - b);
    const fresh = await run.facts(numbers.filter((number) => !known.has(number)));
    const facts = new Map([
      ...known,
      ...fresh.map((one) => /** @type {const} */ ([one.number, one])),
    ]);
    const all = new Map(
      numbers.map((number) => [number, /** @type {Known} */ (facts.get(number))]),
    );
    const { gone, wanted } = changesBetween(known.values(), all.values());
    const removals = gone.map((name) => ({ type: "RemoveSceneNodeMessage", name, owner: "" }));
    return { all, messages: [...removals, ...(await run.messages(wanted))] };
  }

  /**
   * The values of the watched stores.
   *
   * @param {Shown} next
   * @param {Iterable<string>} names
   */
  async function storeValues(next, names) {
    const wanted = [...names].map((name) => ({
      name,
      numbers: [...(next.stores.get(name) ?? [])],
    }));
    const value = await run.values(
      wanted.flatMap(({ numbers }) => numbers.map(([, number]) => number)),
    );
    return new Map(
      wanted.map(({ name, numbers }) => [
        name,
        new Map(numbers.map(([key, number]) => [key, value(number)])),
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
    sinks.pictures(display, await run.pictures(next.panes.get(display) ?? []));
  }

  /**
   * Shows a time in seconds; the next one can be asked for when this is done.
   *
   * @param {number} at
   */
  async function show(at) {
    const [number, frame] = frameAt(index, at);
    if (place === `${number}.${frame}`) return;
    const next = shownAt(await run.chunk(number), frame);
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
    run.prepare(number + 1);
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
      const value = await run.values(all.map(([, number]) => number));
      return new Map(all.map(([key, number]) => [key.slice(start.length), value(number)]));
    },
    /**
     * The ids of a display and of those in it, if it is a group.
     *
     * @param {string} display
     */
    within: (display) => within(values.get(ROWS) ?? new Map(), display),
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
      sinks.scene([...messages, ...(await run.messages(numbers))]);
      showStores(await storeValues(shown, watched));
    },
    /** @param {string} display */
    repeat: (display) => showPicture(shown, display),
  };
}
