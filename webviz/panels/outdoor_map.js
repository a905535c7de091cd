// The widget "outdoor map": tracks over map tiles in Web Mercator, which is zoomed and moved.

import { fitted } from "webviz/charts/canvas.js";
import { el, set } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { listenToPanning } from "webviz/panning.js";
import { owned, signal } from "webviz/signals.js";
import { oncePerFrame } from "webviz/timing.js";
import { drawTile, drawTrack } from "./outdoor_drawing.js";
import { makeImages } from "./outdoor_images.js";
import {
  FURTHEST,
  mercator,
  placeAt,
  TILE,
  tilesOf,
  unmercator,
  zoomed,
} from "./outdoor_mercator.js";

/** @import {Page} from "../page/web/extensions.js" */
/** @import {Line, Track} from "./outdoor_drawing.js" */
/** @import {Look, Tile, Vec2} from "./outdoor_mercator.js" */

/** @typedef {{address: string, credit: string, problem: string, tracks: Track[]}} Values */

const FIRST = 17; // level
const WHEEL_STEP = 0.003;
const ASK_MS = 150;

/** @param {Page} page */
export default function install(page) {
  page.widget("outdoor map", (_, send) => outdoorMap(send));
}

/** @param {(tiles: Tile[]) => unknown} send */
function outdoorMap(send) {
  const map = new OutdoorMap(send);
  const { canvas } = map;
  const text = (/** @type {() => string} */ read) => ({ hidden: () => !read() });
  const problem = () => map.latest.value.problem ?? "";
  const credit = () => map.latest.value.credit ?? "";
  const place = () => map.placeText();
  map.listen();
  return {
    element: el(
      "div",
      { class: "wv-plugin-fill" },
      el("div", { class: "wv-empty", role: "status", ...text(problem) }, problem),
      el(
        "div",
        { class: "wv-outdoor" },
        canvas,
        el("div", { class: "wv-outdoor-place", ...text(place) }, place),
        el("div", { class: "wv-outdoor-credit", ...text(credit) }, credit),
      ),
    ),
    head: el(
      "span",
      { class: "wv-panel-tools" },
      iconButton("focus", "Follow the newest fix (0)", () => map.follow(true), {
        "aria-pressed": () => String(map.isFollowed.value),
      }),
      iconButton("plus", "Zoom in (+)", () => map.zoom(1)),
      iconButton("M5 12h14", "Zoom out (-)", () => map.zoom(-1)),
    ),
    /** @param {Values} values @param {(key: string) => any} part */
    update: (values, part) => map.update(values, part),
  };
}

/** A canvas with tracks and the tiles that are asked for. */
class OutdoorMap {
  latest = signal(/** @type {Partial<Values>} */ ({}));
  isFollowed = signal(true);
  /** @type {Line[]} */
  #tracks = [];
  #look = signal(/** @type {Look} */ ({ x: 0.5, y: 0.5, zoom: FURTHEST }));
  #pointer = signal(/** @type {Vec2 | null} */ (null));
  #hasPlace = false;
  #request = "";
  #timer = 0;
  #redraw = oncePerFrame(() => this.#show());
  #images = makeImages(this.#redraw);
  #send;
  canvas = el("canvas", {
    role: "img",
    tabindex: 0,
    "aria-label": () => `Map, level ${Math.round(this.#look.value.zoom)}`,
  });

  /** @param {(tiles: Tile[]) => unknown} send */
  constructor(send) {
    this.#send = send;
    owned(() => {
      clearTimeout(this.#timer);
      this.#images.clear();
    });
  }

  #size() {
    return { width: this.canvas.clientWidth, height: this.canvas.clientHeight };
  }

  /** The place under the pointer, which changes with the map, too; "" without one. */
  placeText() {
    if (!this.#pointer.value) return "";
    const place = placeAt(this.#pointer.value, this.#look.value, this.#size());
    const [longitude, latitude] = unmercator(place);
    return `${latitude.toFixed(6)}°, ${longitude.toFixed(6)}°`;
  }

  /** @param {boolean} isFollowed */
  follow(isFollowed) {
    this.isFollowed.value = isFollowed;
    this.#redraw();
  }

  /** @param {number} by @param {Vec2} [pixel] */
  zoom(by, pixel = [this.canvas.clientWidth / 2, this.canvas.clientHeight / 2]) {
    this.#look.value = zoomed(this.#look.value, by, pixel, this.#size());
    this.#redraw();
  }

  /** @param {number} dx @param {number} dy */
  #move(dx, dy) {
    const { x, y, zoom } = this.#look.value;
    const world = TILE * 2 ** zoom;
    this.#look.value = { x: x - dx / world, y: y - dy / world, zoom };
    this.follow(false);
  }

  listen() {
    listenToPanning(this.canvas, {
      wheel: ({ deltaY, offsetX, offsetY }) =>
        this.zoom(-deltaY * WHEEL_STEP, this.isFollowed.value ? undefined : [offsetX, offsetY]),
      move: (dx, dy) => this.#move(dx, dy),
      keys: {
        "+": () => this.zoom(1),
        "-": () => this.zoom(-1),
        0: () => this.follow(true),
      },
    });
    set(this.canvas, {
      onpointermove: ({ offsetX, offsetY }) => (this.#pointer.value = [offsetX, offsetY]),
      onpointerleave: () => (this.#pointer.value = null),
    });
    const sizes = new ResizeObserver(this.#redraw);
    sizes.observe(this.canvas);
    owned(() => sizes.disconnect());
  }

  #show() {
    if (!this.canvas.clientWidth) return;
    this.#goOn();
    const { context } = fitted(this.canvas);
    const [look, size] = [this.#look.value, this.#size()];
    const tiles = tilesOf(look, size);
    const { imageOf } = this.#images;
    for (const tile of tiles) drawTile(context, tile, { look, size, imageOf });
    for (const [index, line] of this.#tracks.entries())
      drawTrack(context, line, { index, look, size });
    if (this.#hasPlace) this.#ask(tiles);
  }

  // The map goes on with the newest fix, and begins near the first one.
  #goOn() {
    const newest = this.#tracks.find(({ track }) => track.newest)?.track.newest;
    const [start] = this.#tracks.find(({ lines }) => lines.length)?.lines ?? [];
    const first = newest ? mercator(newest) : start;
    if (!first) return;
    const { x, y, zoom } = this.#look.value;
    const [atX, atY] = this.isFollowed.value ? first : [x, y];
    const next = { x: atX, y: atY, zoom: this.#hasPlace ? zoom : FIRST };
    this.#hasPlace = true;
    this.#look.value = next;
  }

  /** @param {Tile[]} tiles */
  #ask(tiles) {
    const isMissing = tiles.some((tile) => !this.#images.has(tile.join("/")));
    const text = JSON.stringify(tiles);
    if (!this.latest.value.address || !isMissing || text === this.#request) return;
    if (this.canvas.closest(".wv-locked")) return; // those of others are shown
    this.#request = text;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#send(tiles), ASK_MS);
  }

  /**
   * @param {Values} values
   * @param {(key: string) => any} part
   */
  update(values, part) {
    if (values.address !== this.latest.value.address) {
      this.#request = "";
      this.#images.clear();
    }
    this.latest.value = values;
    this.#tracks = (values.tracks ?? []).map((track, index) => ({
      track,
      lines: linesOf(track, (number) => part(`track/${index}/${number}`)?.places ?? []),
    }));
    for (const tile of tilesOf(this.#look.value, this.#size())) {
      const name = tile.join("/");
      const entry = part(`tile/${name}`);
      if (entry) this.#images.add(name, entry.image);
    }
    this.#redraw();
  }
}

/**
 * The places of a track in Web Mercator.
 *
 * @param {Track} track
 * @param {(number: number) => number[]} placesOf the longitudes and latitudes of a part
 */
function linesOf({ parts: [first, end] }, placesOf) {
  /** @type {Vec2[]} */
  const lines = [];
  for (let number = first; number < end; number++) {
    const places = placesOf(number);
    for (let i = 0; i + 1 < places.length; i += 2) lines.push(mercator([places[i], places[i + 1]]));
  }
  return lines;
}
