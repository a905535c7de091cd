// The canvas of a pane: draws still pictures and video, and knows which pixel is under the mouse.

import { contextOf } from "webviz/dom.js";
import { placeIn } from "webviz/images/camera_overlay.js";
import { makeVideo } from "webviz/images/video.js";

/** @import {PictureHeader} from "webviz/messages.js" */
/** @import {Vec2} from "webviz/types.js" */
/** @import {Places} from "webviz/images/marks.js" */

/**
 * @typedef {{drawn: () => void, fail: (sentence: string) => void}} PictureListener
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
export function makePicture(canvas, { drawn, fail }) {
  const context = contextOf(canvas);
  const reader = contextOf(document.createElement("canvas"), { willReadFrequently: true });
  /** @type {Vec2} */
  let size = [0, 0];
  /** @type {ReturnType<typeof makeVideo> | null} */
  let video = null;

  /**
   * @param {PictureHeader} header
   * @param {Uint8Array<ArrayBuffer>} data
   */
  async function still({ mime, size: full, swaps }, data) {
    let bitmap = null;
    try {
      bitmap = await createImageBitmap(new Blob([data], { type: mime }));
    } catch {
      throw new Error(`The browser cannot decode this ${mime}: the data is damaged.`);
    }
    draw(bitmap, full);
    bitmap.close();
    if (swaps) swapRedAndBlue();
  }

  /**
   * @param {ImageBitmap | VideoFrame} image
   * @param {Vec2} [full]
   */
  function draw(image, full) {
    const [width, height] =
      "displayWidth" in image
        ? [image.displayWidth, image.displayHeight]
        : [image.width, image.height];
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, { width, height });
    context.drawImage(image, 0, 0);
    size = full ?? [width, height];
    canvas.style.imageRendering =
      canvas.getBoundingClientRect().width > SHARP * width ? "pixelated" : "auto";
    drawn();
  }

  /**
   * Pixels of a part of the picture, read from memory: to read what a graphics card draws is slow.
   *
   * @param {number} left
   * @param {number} top
   * @param {number} width
   * @param {number} height
   */
  function read(left, top, width, height) {
    Object.assign(reader.canvas, { width, height });
    reader.drawImage(canvas, left, top, width, height, 0, 0, width, height);
    return reader.getImageData(0, 0, width, height);
  }

  function swapRedAndBlue() {
    const pixels = read(0, 0, canvas.width, canvas.height);
    const { data } = pixels;
    for (let i = 0; i < data.length; i += 4) [data[i], data[i + 2]] = [data[i + 2], data[i]];
    context.putImageData(pixels, 0, 0);
  }

  return {
    size: () => size,
    /**
     * Shows a picture; fails with a sentence if it cannot be decoded.
     *
     * @param {PictureHeader} header
     * @param {Uint8Array<ArrayBuffer>} data
     */
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
    /** Width of the picture on the screen, in its pixels; it is letter-boxed. */
    width() {
      const { clientWidth, clientHeight } = canvas;
      const aspect = size[1] ? size[0] / size[1] : clientWidth / Math.max(clientHeight, 1);
      return Math.min(clientWidth, clientHeight * aspect) * devicePixelRatio;
    },
    /**
     * Column and row of the full picture under a pointer, null beside it.
     *
     * @param {{clientX: number, clientY: number}} pointer
     * @returns {Vec2 | null}
     */
    pixelAt({ clientX, clientY }) {
      const box = canvas.getBoundingClientRect();
      if (!size[0] || !box.width) return null;
      const scale = Math.min(box.width / size[0], box.height / size[1]);
      const x = Math.floor((clientX - box.left - (box.width - size[0] * scale) / 2) / scale);
      const y = Math.floor((clientY - box.top - (box.height - size[1] * scale) / 2) / scale);
      return x >= 0 && y >= 0 && x < size[0] && y < size[1] ? [x, y] : null;
    },
    /** The places of its pixels in a pane so large. */
    placeIn: (width, height) => placeIn({ camera: null, warp: null, size }, width, height),
    /** Red, green and blue of a pixel as it is drawn. */
    colorAt([x, y]) {
      const column = Math.floor((x * canvas.width) / size[0]);
      const row = Math.floor((y * canvas.height) / size[1]);
      return Array.from(read(column, row, 1, 1).data.subarray(0, 3));
    },
    close() {
      video?.close();
    },
  };
}
