// The value of the pixel under the mouse: as the server has it, or as it is drawn.

import * as channel from "webviz/channel.js";
import { el, setText } from "webviz/dom.js";
import { pixelText } from "webviz/images/pixel_text.js";

/** @import {PictureHeader, PixelValue} from "webviz/messages.js" */
/** @import {Vec2} from "webviz/types.js" */
/** @import {Picture} from "webviz/images/picture.js" */

/** @typedef {{clientX: number, clientY: number}} Mouse */

const READ_MS = 100;

/** @type {Map<string, (value: PixelValue) => void>} */
const readers = new Map();
channel.on("PixelValue", (value) => readers.get(value.display)?.(value));

/**
 * Returns `{element, read(), close()}`: `read` says anew what is under the mouse over a canvas.
 *
 * @param {string} id of the display
 * @param {HTMLCanvasElement} canvas
 * @param {{
 *   picture: Picture, header: () => Partial<PictureHeader>, aboutAt: (mouse: Mouse) => string,
 * }} pane `header` is that of the picture, `aboutAt` says more of a place
 */
export function makeReading(id, canvas, { picture, header, aboutAt }) {
  const element = el("div", { class: "wv-pane-value", hidden: true });
  /** @type {Mouse | null} */
  let mouse = null;
  let lastRead = 0;
  let later = 0;

  /** @param {Vec2} pixel @param {string} text */
  const showText = ([x, y], text) => {
    const about = mouse ? aboutAt(mouse) : "";
    setText(element, [`x ${x} · y ${y}`, text, about].filter(Boolean).join(" · "));
  };

  function read() {
    const pixel = mouse && picture.pixelAt(mouse);
    if (pixel && element.hidden) showText(pixel, "");
    element.hidden = !pixel;
    if (!pixel) return;
    const { readable, legend } = header();
    if (!readable) return showText(pixel, pixelText(picture.colorAt(pixel), legend));
    const now = performance.now();
    clearTimeout(later);
    if (now - lastRead < READ_MS) {
      later = setTimeout(read, lastRead + READ_MS - now); // else a mouse that rests has an old value
      return;
    }
    lastRead = now;
    channel.send({ type: "ReadPixel", display: id, x: pixel[0], y: pixel[1] });
  }

  readers.set(id, ({ x, y, text }) => mouse && showText([x, y], text));
  canvas.addEventListener("pointermove", ({ clientX, clientY }) => {
    mouse = { clientX, clientY };
    read();
  });
  canvas.addEventListener("pointerleave", () => {
    mouse = null;
    element.hidden = true;
  });
  return { element, read, close: () => readers.delete(id) };
}
