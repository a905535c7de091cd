// The chunks of a recorded run: each is some seconds that can be shown by themselves, unpacked when
// they are needed.

/** @import {About, Chunk, RawChunk} from "webviz/recorded/types.js" */

const MAX_UNPACKED = 160 << 20; // bytes; then the one that was used longest ago is dropped

/** @type {Record<string, (buffer: ArrayBuffer) => ArrayBufferView>} */
const VIEWS = {
  "<f2": (buffer) => new Uint16Array(buffer),
  "<f4": (buffer) => new Float32Array(buffer),
  "<f8": (buffer) => new Float64Array(buffer),
  "|u1": (buffer) => new Uint8Array(buffer),
  "<u2": (buffer) => new Uint16Array(buffer),
  "<u4": (buffer) => new Uint32Array(buffer),
  "|i1": (buffer) => new Int8Array(buffer),
  "<i2": (buffer) => new Int16Array(buffer),
  "<i4": (buffer) => new Int32Array(buffer),
};

/**
 * Bytes of the base64 in an element.
 *
 * @param {Element} element
 */
function bytesOf(element) {
  const text = atob(element.textContent ?? "");
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** The facts of the file about its run; null if it is damaged. */
export function about() {
  const element = document.querySelector('script[type="webviz/about"]');
  try {
    const text = new TextDecoder().decode(bytesOf(/** @type {Element} */ (element)));
    return /** @type {About} */ (JSON.parse(text));
  } catch (error) {
    console.info(error);
    return null;
  }
}

/** The chunks of the file: a function that unpacks the one of a number, if it is not unpacked. */
export function chunks() {
  const packed = [...document.querySelectorAll('script[type="webviz/chunk"]')];
  /** @type {Map<number, Chunk>} */
  const unpacked = new Map(); // the one that was used last at the end
  /** @type {Map<number, Promise<Chunk>>} */
  const underway = new Map();

  /** @param {number} number */
  function at(number) {
    const chunk = unpacked.get(number);
    if (chunk) {
      unpacked.delete(number);
      unpacked.set(number, chunk);
    }
    return chunk;
  }

  /** @param {number} number */
  async function unpack(number) {
    const stream = new Blob([bytesOf(packed[number])]).stream();
    const whole = await new Response(
      stream.pipeThrough(new DecompressionStream("gzip")),
    ).arrayBuffer();
    const length = new DataView(whole).getUint32(0, true);
    /** @type {RawChunk} */
    const raw = JSON.parse(new TextDecoder().decode(new Uint8Array(whole, 4, length)));
    const start = Math.ceil((4 + length) / 8) * 8;
    const chunk = { ...raw, number, bytes: new Uint8Array(whole, start) };
    unpacked.set(number, chunk);
    let size = 0;
    for (const each of unpacked.values()) size += each.bytes.byteLength;
    for (const [oldest, each] of unpacked) {
      if (size <= MAX_UNPACKED || oldest === number) break;
      unpacked.delete(oldest);
      size -= each.bytes.byteLength;
    }
    return chunk;
  }

  return async (/** @type {number} */ number) => {
    const entry = at(number) ?? underway.get(number);
    if (entry) return entry;
    const promise = unpack(number);
    underway.set(number, promise);
    try {
      return await promise;
    } finally {
      underway.delete(number);
    }
  };
}

/**
 * A copy of a buffer of a chunk.
 *
 * @param {Chunk} chunk
 * @param {number} number
 */
export function bufferOf(chunk, number) {
  const [start, size, width] = chunk.buffers[number];
  const bytes = chunk.bytes.slice(start, start + size);
  if (width === 1) return bytes.buffer;
  // The first bytes of all numbers come first, then the second ones, and so on.
  const count = size / width;
  const whole = new Uint8Array(size);
  for (let part = 0; part < width; part++) {
    const from = part * count;
    for (let i = 0, to = part; i < count; i++, to += width) whole[to] = bytes[from + i];
  }
  return whole.buffer;
}

/**
 * A value of a message as viser's page expects it: with arrays, and floats that JSON lacks.
 *
 * @param {Chunk} chunk
 * @param {any} value
 * @returns {any}
 */
export function revived(chunk, value) {
  if (Array.isArray(value)) return value.map((each) => revived(chunk, each));
  if (value === null || typeof value !== "object") return value;
  if ("__array" in value) {
    const view = VIEWS[value.dtype] ?? VIEWS["|u1"];
    return view(bufferOf(chunk, value.__array));
  }
  if ("__float" in value)
    return { nan: NaN, inf: Infinity, "-inf": -Infinity }[String(value.__float)];
  return Object.fromEntries(
    Object.entries(value).map(([key, each]) => [key, revived(chunk, each)]),
  );
}
