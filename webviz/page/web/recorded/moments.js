// Contents of a recorded run at each of its frames, by numbers of messages, values and pictures.

/** @import {Chunk, ChunkIndex, RecordedState} from "webviz/recorded/types.js" */

/**
 * The last item of a sorted list that is not above a value; at least the first.
 *
 * @template T
 * @param {T[]} list
 * @param {(item: T) => number} of
 * @param {number} value
 */
export function lastUpTo(list, of, value) {
  let [low, high] = [0, list.length - 1];
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (of(list[middle]) <= value) low = middle;
    else high = middle - 1;
  }
  return low;
}

/**
 * The chunk and the frame within it that are shown at a time.
 *
 * @param {Pick<ChunkIndex, "times">[]} index
 * @param {number} at
 * @returns {[chunk: number, frame: number]}
 */
export function frameAt(index, at) {
  const chunk = lastUpTo(index, ({ times }) => times[0], at + 1e-6);
  return [chunk, lastUpTo(index[chunk].times, (time) => time, at + 1e-6)];
}

/**
 * Finds the contents of a frame of a chunk.
 *
 * @param {Pick<Chunk, "start" | "frames">} chunk
 * @param {number} frame
 * @returns {RecordedState}
 */
export function shownAt(chunk, frame) {
  const { scene, stores, panes } = chunk.start;
  /** @type {RecordedState} */
  const state = {
    ros: chunk.frames[frame][1],
    scene: new Set(scene),
    stores: new Map(
      Object.entries(stores).map(([name, values]) => [name, new Map(Object.entries(values))]),
    ),
    panes: new Map(Object.entries(panes)),
  };
  for (const [, , added, removals, values, pictures] of chunk.frames.slice(1, frame + 1)) {
    for (const number of removals) state.scene.delete(number);
    for (const number of added) state.scene.add(number);
    for (const [store, key, number] of values) {
      const content = state.stores.get(store) ?? new Map();
      state.stores.set(store, content);
      if (number < 0) content.delete(key);
      else content.set(key, number);
    }
    for (const [display, numbers] of pictures) {
      if (numbers.length) state.panes.set(display, numbers);
      else state.panes.delete(display);
    }
  }
  return state;
}

/**
 * The ids of a display and of those in it, if it is a group; of all for "".
 *
 * @param {Map<string, any>} rows the store of displays
 * @param {string} display
 * @returns {string[]}
 */
export function within(rows, display) {
  /** @type {string[]} */
  const order = rows.get("order") ?? [];
  if (!display) return order;
  const first = order.indexOf(display);
  const depth = rows.get(display)?.depth ?? 0;
  const end = order.findIndex((id, at) => at > first && rows.get(id).depth <= depth);
  return order.slice(first, end < 0 ? undefined : end);
}
