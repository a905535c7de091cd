// Everything that was recorded, by number; chunks are unpacked as they are needed.

import { bufferOf, chunks, revived } from "webviz/recorded/chunks.js";
import { lastUpTo } from "webviz/recorded/moments.js";

/** @import {ViserMessage} from "webviz/types.js" */
/** @import {Chunk, ChunkIndex, MessageFacts} from "webviz/recorded/types.js" */

/** @typedef {"message" | "value" | "picture"} Kind */

/**
 * A value of a store, which shares parts with others.
 *
 * @param {Chunk} chunk
 * @param {number} number
 */
function valueIn({ values: { first, items, places, shared } }, number) {
  const item = /** @type {any} */ (items[places[number - first]]);
  if (!item?.__each) return item;
  return { each: item.__each.map((/** @type {number} */ one) => shared[one]) };
}

/**
 * A function that resolves with what finds the chunk of each of some messages, values or pictures.
 *
 * @param {ChunkIndex[]} index
 * @param {(place: number) => Promise<Chunk>} chunk
 */
function homesIn(index, chunk) {
  /**
   * The number of the chunk that has a message, value or picture.
   *
   * @param {Kind} kind
   * @param {number} number
   */
  const home = (kind, number) => lastUpTo(index, (each) => each[kind], number);

  /**
   * @param {Kind} kind
   * @param {number[]} numbers
   * @returns {Promise<(number: number) => Chunk>}
   */
  return async (kind, numbers) => {
    /** @type {Map<number, Chunk>} */
    const chunks = new Map();
    for (const place of new Set(numbers.map((number) => home(kind, number))))
      chunks.set(place, await chunk(place));
    return (number) => /** @type {Chunk} */ (chunks.get(home(kind, number)));
  };
}

/**
 * Returns `{chunk(number), prepare(number), facts(numbers), messages(numbers), values(numbers), pictures(numbers)}`.
 *
 * @param {ChunkIndex[]} index
 */
export function archive(index) {
  const chunk = chunks();
  const homes = homesIn(index, chunk);

  return {
    chunk,
    /** @param {number} number of a chunk that will be needed soon */
    prepare: (number) => number < index.length && chunk(number),
    /**
     * The nodes, keys and phases of messages.
     *
     * @param {number[]} numbers
     * @returns {Promise<MessageFacts[]>}
     */
    async facts(numbers) {
      const of = await homes("message", numbers);
      return numbers.map((number) => {
        const { first, items } = of(number).messages;
        const [key, node, phase] = items[number - first];
        return { number, key, node, phase };
      });
    },
    /**
     * Messages as viser's page expects them.
     *
     * @param {number[]} numbers
     * @returns {Promise<ViserMessage[]>}
     */
    async messages(numbers) {
      const of = await homes("message", numbers);
      return numbers.map((number) => {
        const { first, items } = of(number).messages;
        return revived(of(number), items[number - first][3]);
      });
    },
    /**
     * A function of the number of a value.
     *
     * @param {number[]} numbers
     * @returns {Promise<(number: number) => any>}
     */
    async values(numbers) {
      const of = await homes("value", numbers);
      return (number) => valueIn(of(number), number);
    },
    /**
     * Functions that make the messages of pictures.
     *
     * @param {number[]} numbers
     * @returns {Promise<(() => ArrayBuffer)[]>}
     */
    async pictures(numbers) {
      const of = await homes("picture", numbers);
      return numbers.map((number) => () => {
        const { first, items } = of(number).pictures;
        return bufferOf(of(number), items[number - first]);
      });
    },
  };
}
