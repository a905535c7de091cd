// Updates of nodes that came in pieces, as on slow links: put together, viser handles them as ever.

import * as viser from "webviz/viser_page.js";

/** @import {ViserMessage} from "webviz/types.js" */

const KIND = "webviz:Piece";
/** @type {Record<string, {new (buffer: ArrayBufferLike, start: number, count: number): ArrayLike<number>, BYTES_PER_ELEMENT: number}>} */
const NUMBERS = {
  "<f2": Uint16Array, // as viser has them
  "<f4": Float32Array,
  "<f8": Float64Array,
  "|u1": Uint8Array,
  "<u2": Uint16Array,
  "<u4": Uint32Array,
  "|i1": Int8Array,
  "<i2": Int16Array,
  "<i4": Int32Array,
};

export function install() {
  /** @type {Uint8Array[]} */
  const slots = [];

  /** @param {ViserMessage} message */
  function take(message) {
    if (message.type !== KIND) return [message];
    const { slot, start, size, data, update } = message;
    if (start === 0) slots[slot] = new Uint8Array(size);
    const bytes = slots[slot];
    if (bytes?.length !== size) return []; // of an update whose beginning was lost
    bytes.set(data, start);
    if (!update) return [];
    delete slots[slot];
    const updates = Object.fromEntries(
      Object.entries(update.values).map(([name, value]) => [name, valueOf(value, bytes)]),
    );
    return [{ type: "SceneNodeUpdateMessage", name: update.name, owner: update.owner, updates }];
  }

  viser.filterMessages((messages) => messages.flatMap(take));
}

/**
 * @param {any} value
 * @param {Uint8Array} bytes
 */
function valueOf({ value, start, end, dtype }, bytes) {
  if (start === undefined) return value;
  if (dtype === "") return bytes.slice(start, end);
  const Numbers = NUMBERS[dtype];
  return new Numbers(bytes.buffer, start, (end - start) / Numbers.BYTES_PER_ELEMENT);
}
