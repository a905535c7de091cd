// Textures of models: equal ones are decoded once, and are once in the graphics card.
//
// The parts of a robot often have the same pictures, and each model brings its own.

import { signal } from "webviz/signals.js";
import * as viser from "webviz/viser_page.js";

/** @import {TextureSource} from "three" */
/** @import {SceneObject} from "webviz/types.js" */

const SEED = 0x811c9dc5;
const PRIMES = [0x01000193, 0x85ebca6b]; // of two hashes by words, as FNV-1a has them by bytes

/** @type {Map<string, Promise<WeakRef<ImageBitmap> | undefined>>} */
const decoded = new Map(); // promises of weak references to pictures, by their content
const registry = new FinalizationRegistry((content) => decoded.delete(content));
/** @type {WeakMap<ImageBitmap, TextureSource<ImageBitmap>>} */
const sources = new WeakMap(); // by picture, what three.js uploads
/** @type {WeakSet<object>} */
const shared = new WeakSet(); // materials
const isShared = signal(false);

export function install() {
  const decode = window.createImageBitmap.bind(window);
  /** @type {(image: ImageBitmapSource, ...rest: any[]) => Promise<ImageBitmap>} */
  const shareOrDecode = (image, ...rest) => {
    const isOfModel = image instanceof Blob && rest[0]?.premultiplyAlpha === "none"; // by three.js
    return isOfModel
      ? once(image, rest[0], decode)
      : Reflect.apply(decode, window, [image, ...rest]);
  };
  window.createImageBitmap = shareOrDecode;
  viser.beforeEveryRender((gl, scene) => isShared.value && scene.traverse(share));
}

/**
 * @param {Blob} image
 * @param {ImageBitmapOptions} options
 * @param {typeof createImageBitmap} decode
 */
async function once(image, options, decode) {
  const content = `${await hash(image)} ${image.type} ${JSON.stringify(options)}`;
  const hit = (await decoded.get(content))?.deref();
  isShared.value ||= Boolean(hit);
  if (hit) return hit;
  const decoding = decode(image, options);
  const reference = decoding
    .then((bitmap) => new WeakRef(bitmap))
    .catch(() => void decoded.delete(content));
  decoded.set(content, reference);
  const bitmap = await decoding;
  registry.register(bitmap, content);
  return bitmap;
}

/** @param {Blob} image */
async function hash(image) {
  const bytes = await image.arrayBuffer();
  const words = new Uint32Array(bytes, 0, bytes.byteLength >> 2);
  let [a, b] = [SEED, SEED];
  for (const word of words) {
    a = Math.imul(a ^ word, PRIMES[0]);
    b = Math.imul(b ^ word, PRIMES[1]);
  }
  return [bytes.byteLength, a, b].join();
}

// Textures of one picture have one source, which three.js uploads once.
/** @param {SceneObject} mesh */
function share({ material }) {
  if (!material || shared.has(material)) return;
  shared.add(material);
  for (const texture of Object.values(material)) {
    const picture = texture?.isTexture && texture.image;
    if (!(picture instanceof ImageBitmap)) continue;
    if (!sources.has(picture)) sources.set(picture, texture.source);
    texture.source = sources.get(picture);
  }
}
