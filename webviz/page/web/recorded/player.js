// Shows a recorded run at a time, to viser's page and to listeners of stores and pictures.

import { archive } from "webviz/recorded/archive.js";
import { frameAt, shownAt, within } from "webviz/recorded/moments.js";
import { changesBetween } from "webviz/recorded/scene_changes.js";
import { switches } from "webviz/recorded/switches.js";

/** @import {ViserMessage} from "webviz/types.js" */
/** @import {About, MessageFacts, RecordedState} from "webviz/recorded/types.js" */

/**
 * @typedef {{
 *   scene(messages: ViserMessage[]): void,
 *   store(name: string, all: boolean, set: Record<string, unknown>, gone: string[]): void,
 *   pictures(display: string, make: (() => ArrayBuffer)[]): void,
 * }} Sinks
 */

const ROWS = "displays";

/** @type {RecordedState} */
const NOTHING = { ros: 0, scene: new Set(), stores: new Map(), panes: new Map() };

/** Shows the moments of a run, and answers what is asked of the one that is shown. */
export class Player {
  #index;
  #run;
  #sinks;
  #state = NOTHING;
  #place = ""; // the chunk and the frame that are shown
  /** @type {Map<number, MessageFacts>} */
  #nodes = new Map(); // of the scene
  /** @type {Map<string, Map<string, unknown>>} */
  #values = new Map(); // of the stores that are shown, by key
  /** @type {Set<string>} */
  #watched = new Set();
  #switched = switches();

  /**
   * @param {About} about
   * @param {Sinks} sinks
   */
  constructor({ index }, sinks) {
    this.#index = index;
    this.#run = archive(index);
    this.#sinks = sinks;
  }

  /**
   * Shows a time in seconds; the next one can be asked for when this is done.
   *
   * @param {number} at
   */
  async show(at) {
    const [number, frame] = frameAt(this.#index, at);
    const place = `${number}.${frame}`;
    if (this.#place === place) return;
    const next = shownAt(await this.#run.chunk(number), frame);
    const { all, messages } = await sceneMessages(this.#run, this.#nodes, next);
    const stores = await storeValues(this.#run, next, this.#watched);
    const before = this.#state;
    this.#state = next;
    this.#place = place;
    this.#nodes = all;
    this.#sinks.scene(this.#switched.messages(messages));
    this.#showStores(stores);
    for (const display of new Set([...before.panes.keys(), ...next.panes.keys()])) {
      const isSame = before.panes.get(display)?.join() === next.panes.get(display)?.join();
      if (!isSame) await this.#showPicture(next, display);
    }
    this.#run.prepare(number + 1);
  }

  /** The ROS time of the frame that is shown. */
  ros() {
    return this.#state.ros;
  }

  /**
   * A value of a store that the page watches.
   *
   * @param {string} store
   * @param {string} key
   * @returns {any}
   */
  value(store, key) {
    return this.#values.get(store)?.get(key);
  }

  /**
   * The values of a store whose keys begin with a text, by the rest of their keys.
   *
   * @param {string} store
   * @param {string} start
   */
  async read(store, start) {
    const all = [...(this.#state.stores.get(store) ?? [])].filter(([key]) => key.startsWith(start));
    const value = await this.#run.values(all.map(([, number]) => number));
    return new Map(all.map(([key, number]) => [key.slice(start.length), value(number)]));
  }

  /**
   * The ids of a display and of those in it, if it is a group.
   *
   * @param {string} display
   */
  within(display) {
    return within(this.#values.get(ROWS) ?? new Map(), display);
  }

  /** @param {string} name */
  async watch(name) {
    this.#watched.add(name);
    this.#values.delete(name);
    if (this.#place) this.#showStores(await storeValues(this.#run, this.#state, [name]));
  }

  /** @param {string} name */
  unwatch(name) {
    this.#watched.delete(name);
    this.#values.delete(name);
  }

  /**
   * Switches a display on or off.
   *
   * @param {string} display
   * @param {boolean} enabled
   */
  async enable(display, enabled) {
    const problem = this.#switched.set(display, enabled);
    if (problem) throw new Error(problem);
    const { messages, numbers } = this.#switched.difference(this.#nodes.values());
    this.#sinks.scene([...messages, ...(await this.#run.messages(numbers))]);
    this.#showStores(await storeValues(this.#run, this.#state, this.#watched));
  }

  /**
   * Shows the picture of a display again.
   *
   * @param {string} display
   */
  repeat(display) {
    return this.#showPicture(this.#state, display);
  }

  /**
   * Shows the stores of these names as they are now.
   *
   * @param {Map<string, Map<string, unknown>>} next
   */
  #showStores(next) {
    // The rows of displays come first: by them is known what is hidden.
    const rows = next.get(ROWS);
    const all = rows ? [[ROWS, rows], ...[...next].filter(([name]) => name !== ROWS)] : [...next];
    for (const [name, recorded] of /** @type {[string, Map<string, unknown>][]} */ (all)) {
      const content = this.#switched.content(name, recorded);
      const before = this.#values.get(name);
      this.#values.set(name, content);
      if (!before) {
        this.#sinks.store(name, true, Object.fromEntries(content), []);
        continue;
      }
      const set = [...content].filter(([key, value]) => before.get(key) !== value);
      const deletions = [...before.keys()].filter((key) => !content.has(key));
      if (set.length || deletions.length)
        this.#sinks.store(name, false, Object.fromEntries(set), deletions);
    }
  }

  /**
   * @param {RecordedState} next
   * @param {string} display
   */
  async #showPicture(next, display) {
    this.#sinks.pictures(display, await this.#run.pictures(next.panes.get(display) ?? []));
  }
}

/** @typedef {ReturnType<typeof archive>} Archive */

/**
 * All that the scene consists of at a moment, and the messages that lead there from what is known.
 *
 * @param {Archive} run
 * @param {Map<number, MessageFacts>} before
 * @param {RecordedState} next
 */
async function sceneMessages(run, before, next) {
  const numbers = [...next.scene].sort((a, b) => a - b);
  const fresh = await run.facts(numbers.filter((number) => !before.has(number)));
  const facts = new Map([
    ...before,
    ...fresh.map((one) => /** @type {const} */ ([one.number, one])),
  ]);
  const all = new Map(
    numbers.map((number) => [number, /** @type {MessageFacts} */ (facts.get(number))]),
  );
  const { deletions, updates } = changesBetween(before.values(), all.values());
  const removals = deletions.map((name) => ({ type: "RemoveSceneNodeMessage", name, owner: "" }));
  return { all, messages: [...removals, ...(await run.messages(updates))] };
}

/**
 * The values of the stores of these names at a moment, by their keys.
 *
 * @param {Archive} run
 * @param {RecordedState} next
 * @param {Iterable<string>} names
 */
async function storeValues(run, next, names) {
  const entries = [...names].map((name) => ({
    name,
    numbers: [...(next.stores.get(name) ?? [])],
  }));
  const value = await run.values(
    entries.flatMap(({ numbers }) => numbers.map(([, number]) => number)),
  );
  return new Map(
    entries.map(({ name, numbers }) => [
      name,
      new Map(numbers.map(([key, number]) => [key, value(number)])),
    ]),
  );
}
