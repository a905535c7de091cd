// The canvas of a pane: draws still pictures and video, and knows which pixel is under the mouse.

import { contextOf } from "webviz/dom.js";
import { placeIn } from "webviz/images/camera_overlay.js";
import { makeVideo } from "webviz/images/video.js";

/** @import {PictureHeader} from "webviz/messages.js" */
/** @import {Vec2} from "webviz/types.js" */
/** @import {Places} from "webviz/images/marks.js" */

/**
 * @typedef {{onDraw: () => void, fail: (sentence: string) => void}} PictureListener
 * @typedef {{
 *   size: () => Vec2, take: (header: PictureHeader, data: Uint8Array<ArrayBuffer>) => Promise<void>,
 *   width: () => number, pixelAt: (pointer: {clientX: number, clientY: number}) => Vec2 | null,
 *   placeIn: (width: number, height: number) => Places,
 *   colorAt: (pixel: Vec2) => number[], hide?: (ids: string[]) => void, close: () => void,
 * }} Picture
 */

const SHARP = 2;

/**
 * `drawn()` is called whenever there is another picture, `fail(sentence)` if a video is damaged.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {PictureListener} listener
 * @returns {Picture}
 */
export function makePicture(canvas, { onDraw, fail }) {
  const context = contextOf(canvas);
  const pixels = pixelsOf(canvas);
  /** @type {Vec2} */
  let size = [0, 0];
  /** @type {ReturnType<typeof makeVideo> | null} */
  let video = null;

  /**
   * @param {PictureHeader} header
   * @param {Uint8Array<ArrayBuffer>} data
   */
  async function still({ mime, size: full, swaps }, data) {
    const bitmap = await decode(data, mime);
    draw(bitmap, full);
    bitmap.close();
    if (swaps) context.putImageData(swapped(pixels(0, 0, canvas.width, canvas.height)), 0, 0);
  }

  /**
   * @param {ImageBitmap | VideoFrame} image
   * @param {Vec2} [full]
   */
  function draw(image, full) {
    const own = sizeOf(image);
    fill(canvas, context, image, own);
    size = full ?? own;
    onDraw();
  }

  return {
    size: () => size,
    /** Shows a picture; fails with a sentence if it cannot be decoded. */
    async take(header, data) {
      if (header.is_same) return;
      if (!header.video) {
        video?.close();
        video = null;
        return still(header, data);
      }
      video ??= makeVideo(draw, fail);
      return video.take(header, data);
    },
    width: () => widthIn(canvas, size),
    pixelAt: (pointer) => pixelUnder(canvas, size, pointer),
    /** The places of its pixels in a pane so large. */
    placeIn: (width, height) => placeIn({ camera: null, warp: null, size }, width, height),
    /** Red, green and blue of a pixel as it is drawn. */
    colorAt([x, y]) {
      const column = Math.floor((x * canvas.width) / size[0]);
      const row = Math.floor((y * canvas.height) / size[1]);
      return Array.from(pixels(column, row, 1, 1).data.subarray(0, 3));
    },
    close: () => video?.close(),
  };
}

/**
 * @param {Uint8Array<ArrayBuffer>} data
 * @param {string} [mime]
 */
async function decode(data, mime) {
  try {
    return await createImageBitmap(new Blob([data], { type: mime }));
  } catch {
    throw new Error(`The browser cannot decode this ${mime}: the data is damaged.`);
  }
}

/**
 * @param {ImageBitmap | VideoFrame} image
 * @returns {Vec2}
 */
const sizeOf = (image) =>
  "displayWidth" in image ? [image.displayWidth, image.displayHeight] : [image.width, image.height];

/**
 * Draws an image into a canvas, which gets its size.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {CanvasRenderingContext2D} context
 * @param {ImageBitmap | VideoFrame} image
 * @param {Vec2} size
 */
function fill(canvas, context, image, [width, height]) {
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  context.drawImage(image, 0, 0);
  canvas.style.imageRendering =
    canvas.getBoundingClientRect().width > SHARP * width ? "pixelated" : "auto";
}

/**
 * Reads the pixels of a part of a canvas from memory: to read what a graphics card draws is slow.
 *
 * @param {HTMLCanvasElement} canvas
 */
function pixelsOf(canvas) {
  const reader = contextOf(document.createElement("canvas"), { willReadFrequently: true });
  /**
   * @param {number} left
   * @param {number} top
   * @param {number} width
   * @param {number} height
   */
  return (left, top, width, height) => {
    Object.assign(reader.canvas, { width, height });
    reader.drawImage(canvas, left, top, width, height, 0, 0, width, height);
    return reader.getImageData(0, 0, width, height);
  };
}

/**
 * Exchanges red and blue.
 *
 * @param {ImageData} pixels
 */
function swapped(pixels) {
  const { data } = pixels;
  for (let i = 0; i < data.length; i += 4) [data[i], data[i + 2]] = [data[i + 2], data[i]];
  return pixels;
}

/**
 * Width of a picture on the screen, in its pixels; it is letter-boxed.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {Vec2} size
 */
function widthIn({ clientWidth, clientHeight }, size) {
  const aspect = size[1] ? size[0] / size[1] : clientWidth / Math.max(clientHeight, 1);
  return Math.min(clientWidth, clientHeight * aspect) * devicePixelRatio;
}

/**
 * Column and row of the full picture under a pointer, null beside it.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {Vec2} size
 * @param {{clientX: number, clientY: number}} pointer
 * @returns {Vec2 | null}
 */
function pixelUnder(canvas, size, { clientX, clientY }) {
  const box = canvas.getBoundingClientRect();
  if (!size[0] || !box.width) return null;
  const scale = Math.min(box.width / size[0], box.height / size[1]);
  const x = Math.floor((clientX - box.left - (box.width - size[0] * scale) / 2) / scale);
  const y = Math.floor((clientY - box.top - (box.height - size[1] * scale) / 2) / scale);
  return x >= 0 && y >= 0 && x < size[0] && y < size[1] ? [x, y] : null;
}
