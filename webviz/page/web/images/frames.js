// Pictures from the server: a header as JSON behind its length, and the files it describes.

import * as channel from "webviz/channel.js";
import constants from "webviz/constants.js";
import { signal } from "webviz/signals.js";
import { debounced, oncePerFrame } from "webviz/timing.js";

/** @import {PictureHeader} from "webviz/messages.js" */

/**
 * @typedef {{
 *   width: () => number, take: (header: PictureHeader, data: Uint8Array<ArrayBuffer>) => unknown,
 * }} PicturePane
 */

const COARSE = 64;
const SETTLE_MS = 100;

/** @type {Map<string, PicturePane>} */
const panes = new Map();
/** @type {Map<string, Promise<unknown>>} */
const deliveries = new Map(); // by display, the promise of the newest picture
/** @type {Map<string, number>} */
const acknowledgements = new Map();
const lastRequest = signal(""); // each page says once that it has panes, and which it shows

/** Tells the server soon which pictures are shown, and how wide. */
export const refresh = debounced(ask, SETTLE_MS);

/** Confirms pictures of all panes in one message. */
const confirm = oncePerFrame(() => {
  channel.send({ type: "FramesShown", numbers: Object.fromEntries(acknowledgements) });
  acknowledgements.clear();
});

channel.onBytes((buffer) => {
  const length = new DataView(buffer).getUint32(0, true);
  /** @type {PictureHeader} */
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const data = new Uint8Array(buffer, 4 + length);
  const { display, number } = header;
  // One after another: a later one that is decoded sooner must not be drawn first. Also without a
  // pane, which may come back before the server hears that it was gone.
  const take = () => panes.get(display)?.take(header, data);
  const acknowledge = () => {
    acknowledgements.set(display, number);
    confirm();
  };
  deliveries.set(
    display,
    (deliveries.get(display) ?? Promise.resolve()).then(take).then(acknowledge, acknowledge),
  );
});

channel.onOpen(() => {
  lastRequest.value = "";
  ask();
});
document.addEventListener("visibilitychange", ask);

/**
 * Shows the pictures of a display. `pane.width()` is how wide they are shown in pixels of the
 * screen, 0 for not at all; `pane.take(header, data)` resolves when the next picture can come.
 *
 * @param {string} display
 * @param {PicturePane} pane
 */
export function open(display, pane) {
  panes.set(display, pane);
  refresh();
}

/** @param {string} display */
export function close(display) {
  panes.delete(display);
  deliveries.delete(display);
  refresh();
}

function ask() {
  const all = document.hidden ? [] : [...panes];
  const sizes = all.map(([display, pane]) => ({ display, width: pane.width() }));
  const looked = sizes.filter(({ width }) => width > 0).slice(0, constants.MAX_PANES);
  const widths = Object.fromEntries(
    looked.map(({ display, width }) => [
      display,
      Math.min(Math.ceil(width / COARSE) * COARSE, 1 << 16),
    ]),
  );
  const request = JSON.stringify(widths);
  if (request === lastRequest.value) return;
  lastRequest.value = request;
  if (channel.isOpen()) channel.send({ type: "ShowPictures", widths });
}
