// The widget "outdoor map": tracks over map tiles in Web Mercator, which is zoomed and moved.

import { fitted } from "webviz/charts/canvas.js";
import { el, set, setText, showText } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { listenToPanning } from "webviz/panning.js";
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

const FIRST = 17; // level
const WHEEL_STEP = 0.003;
const ASK_MS = 150;

/** @param {Page} page */
export default function install(page) {
  page.widget("outdoor map", (_, send) => outdoorMap(send));
}

/**
 * @param {(tiles: Tile[]) => unknown} send
 */
function outdoorMap(send) {
  const images = makeImages(soon);
  /** @type {Line[]} */
  let tracks = [];
  /** @type {Look} */
  let look = { x: 0.5, y: 0.5, zoom: FURTHEST };
  let isFollowed = true;
  let hasPlace = false;
  let address = "";
  let asked = "";
  let timer = 0;
  let request = 0;
  /** @type {Vec2 | null} */
  let pointer = null;

  const canvas = el("canvas", { role: "img", tabindex: 0, "aria-label": "Map" });
  const credit = el("div", { class: "wv-outdoor-credit", hidden: true });
  const place = el("div", { class: "wv-outdoor-place", hidden: true });
  const problem = el("div", { class: "wv-empty", role: "status" });
  const follow = iconButton("focus", "Follow the newest fix (0)", () => setFollowed(true));
  const element = el(
    "div",
    { class: "wv-plugin-fill" },
    problem,
    el("div", { class: "wv-outdoor" }, canvas, place, credit),
  );

  const head = el(
    "span",
    { class: "wv-panel-tools" },
    follow,
    iconButton("plus", "Zoom in (+)", () => zoom(1)),
    iconButton("M5 12h14", "Zoom out (-)", () => zoom(-1)),
  );

  const size = () => ({ width: canvas.clientWidth, height: canvas.clientHeight });

  function soon() {
    request ||= requestAnimationFrame(show);
  }

  /** @param {boolean} wanted */
  function setFollowed(wanted) {
    isFollowed = wanted;
    set(follow, { "aria-pressed": String(isFollowed) });
    soon();
  }

  function show() {
    request = 0;
    if (!canvas.clientWidth) return;
    const newest = tracks.find(({ track }) => track.newest)?.track.newest;
    const first = newest ? mercator(newest) : tracks.find(({ lines }) => lines.length)?.lines[0];
    if (first && isFollowed) look = { ...look, x: first[0], y: first[1] };
    if (first && !hasPlace) look = { ...look, zoom: FIRST };
    hasPlace ||= first !== undefined;
    const { context } = fitted(canvas);
    const wanted = tilesOf(look, size());
    for (const tile of wanted)
      drawTile(context, tile, { look, size: size(), imageOf: images.imageOf });
    for (const [index, line] of tracks.entries())
      drawTrack(context, line, { index, look, size: size() });
    set(canvas, { "aria-label": `Map, level ${Math.round(look.zoom)}` });
    showPlace();
    if (hasPlace) ask(wanted);
  }

  /** The place under the pointer, which changes with the map, too. */
  function showPlace() {
    place.hidden = !pointer;
    if (!pointer) return;
    const [longitude, latitude] = unmercator(placeAt(pointer, look, size()));
    setText(place, `${latitude.toFixed(6)}°, ${longitude.toFixed(6)}°`);
  }

  /** @param {Tile[]} wanted */
  function ask(wanted) {
    const isMissing = wanted.some((tile) => !images.has(tile.join("/")));
    const text = JSON.stringify(wanted);
    if (!address || !isMissing || text === asked) return;
    if (canvas.closest(".wv-locked")) return; // those of others are shown
    asked = text;
    clearTimeout(timer);
    timer = setTimeout(() => send(wanted), ASK_MS);
  }

  /** @param {number} by @param {Vec2} [pixel] */
  function zoom(by, pixel = [canvas.clientWidth / 2, canvas.clientHeight / 2]) {
    look = zoomed(look, by, pixel, size());
    soon();
  }

  listenToPanning(canvas, {
    wheel: ({ deltaY, offsetX, offsetY }) =>
      zoom(-deltaY * WHEEL_STEP, isFollowed ? undefined : [offsetX, offsetY]),
    move(dx, dy) {
      const world = TILE * 2 ** look.zoom;
      look = { ...look, x: look.x - dx / world, y: look.y - dy / world };
      setFollowed(false);
    },
    keys: { "+": () => zoom(1), "-": () => zoom(-1), 0: () => setFollowed(true) },
  });
  canvas.addEventListener("pointermove", ({ offsetX, offsetY }) => {
    pointer = [offsetX, offsetY];
    showPlace();
  });
  canvas.addEventListener("pointerleave", () => {
    pointer = null;
    showPlace();
  });
  const sizes = new ResizeObserver(soon);
  sizes.observe(canvas);

  /**
   * @param {{address: string, credit: string, problem: string, tracks: Track[]}} values
   * @param {(key: string) => any} part
   */
  function update(values, part) {
    if (values.address !== address) {
      address = values.address;
      asked = "";
      images.clear();
    }
    showText(problem, values.problem ?? "");
    showText(credit, values.credit ?? "");
    tracks = (values.tracks ?? []).map((track, index) => {
      /** @type {Vec2[]} */
      const lines = [];
      for (let number = track.parts[0]; number < track.parts[1]; number++) {
        const places = part(`track/${index}/${number}`)?.places ?? [];
        for (let i = 0; i + 1 < places.length; i += 2)
          lines.push(mercator([places[i], places[i + 1]]));
      }
      return { track, lines };
    });
    for (const tile of tilesOf(look, size())) {
      const name = tile.join("/");
      const found = part(`tile/${name}`);
      if (found) images.add(name, found.image);
    }
    soon();
  }

  setFollowed(true);
  return {
    element,
    head,
    update,
    close() {
      sizes.disconnect();
      clearTimeout(timer);
      cancelAnimationFrame(request);
      images.clear();
    },
  };
}
