// The widget "outdoor map": tracks over map tiles in Web Mercator, which is zoomed and moved.

/** @import {Page} from "../page/web/extensions.js" */

/**
 * @typedef {[number, number]} Vec2
 * @typedef {{topic: string, is_path: boolean, parts: Vec2, newest: Vec2 | null}} Track
 * @typedef {{x: number, y: number, zoom: number}} Look the middle as shares of the world, and the level
 */

const TILE = 256; // pixels of a tile at its own level
const NEAREST = 21;
const FURTHEST = 1;
const FIRST = 17;
const DEEPER = 3; // levels above a tile that is missing, of which parts are shown
const WHEEL_STEP = 0.003;
const ASK_MS = 150;
const MAX_TILES = 400;
const HUES = [210, 28, 140, 0, 270, 180, 60, 320];
const RULES = `
.wv-outdoor { position: relative; flex: 1; min-height: 200px; overflow: hidden; background: var(--wv-field);
  border: 1px solid var(--wv-line); border-radius: var(--wv-radius) }
.wv-outdoor canvas { position: absolute; inset: 0; width: 100%; height: 100%; cursor: grab; touch-action: none }
.wv-outdoor-credit { position: absolute; right: 0; bottom: 0; max-width: 80%; padding: 1px 6px; font-size: 11px;
  background: var(--wv-over); pointer-events: none }
.wv-outdoor-place { position: absolute; left: 0; bottom: 0; padding: 1px 6px; font-size: 11px;
  background: var(--wv-over); pointer-events: none; font-variant-numeric: tabular-nums }
`;

/**
 * A place as shares of the world, from the north-west.
 *
 * @param {Vec2} place longitude and latitude in degrees
 * @returns {Vec2}
 */
export function mercator([longitude, latitude]) {
  const sine = Math.sin((latitude * Math.PI) / 180);
  const y = 0.5 - Math.log((1 + sine) / (1 - sine)) / (4 * Math.PI);
  return [longitude / 360 + 0.5, y];
}

/**
 * The longitude and latitude of shares of the world, in degrees.
 *
 * @param {Vec2} share
 * @returns {Vec2}
 */
export function unmercator([x, y]) {
  const latitude = (Math.atan(Math.sinh(Math.PI * (1 - 2 * y))) * 180) / Math.PI;
  return [(x - 0.5) * 360, latitude];
}

/**
 * The tiles in sight, those in the middle first: level, column and row.
 *
 * @param {Look} look
 * @param {number} width
 * @param {number} height
 * @returns {[number, number, number][]}
 */
export function tilesOf({ x, y, zoom }, width, height) {
  const level = Math.max(0, Math.min(Math.round(zoom), NEAREST));
  const count = 2 ** level;
  const size = TILE * 2 ** (zoom - level);
  const [left, top] = [x * count - width / size / 2, y * count - height / size / 2];
  /** @type {[number, number, number][]} */
  const found = [];
  for (let row = Math.floor(top); row < top + height / size; row++)
    for (let column = Math.floor(left); column < left + width / size; column++)
      if (row >= 0 && row < count && column >= 0 && column < count)
        found.push([level, column, row]);
  /** @param {[number, number, number]} tile */
  const far = ([, column, row]) => Math.hypot(column + 0.5 - x * count, row + 0.5 - y * count);
  return found.toSorted((a, b) => far(a) - far(b));
}

/** @param {Page} page */
export default function install({ el, fitted, iconButton, set, setText, style, widget }) {
  style("outdoor", RULES);
  widget("outdoor map", (_, send) => {
    /** @type {Map<string, ImageBitmap | null>} */
    const tiles = new Map(); // null while one is decoded, and without one
    /** @type {Map<string, string>} */
    const decodedOf = new Map();
    /** @type {{track: Track, lines: Vec2[]}[]} */
    let tracks = [];
    /** @type {Look} */
    const look = { x: 0.5, y: 0.5, zoom: FURTHEST };
    let isFollowed = true;
    let hasPlace = false;
    let address = "";
    let asked = "";
    let timer = 0;
    let request = 0;
    /** @type {Vec2 | null} */
    let held = null;
    /** @type {{offsetX: number, offsetY: number} | null} */
    let pointer = null;

    const canvas = el("canvas", { role: "img", tabindex: 0, "aria-label": "Map" });
    const credit = el("div", { class: "wv-outdoor-credit", hidden: true });
    const place = el("div", { class: "wv-outdoor-place", hidden: true });
    const problem = el("div", { class: "wv-empty", role: "status" });
    const follow = iconButton("focus", "Follow the newest fix (0)", () => setFollowed(true));
    const element = el(
      "div",
      { class: "wv-plugin-fill" },
      el(
        "div",
        { class: "wv-plugin-bar" },
        follow,
        iconButton("plus", "Zoom in (+)", () => zoom(1)),
        iconButton("M5 12h14", "Zoom out (-)", () => zoom(-1)),
      ),
      problem,
      el("div", { class: "wv-outdoor" }, canvas, place, credit),
    );

    const soon = () => {
      request ||= requestAnimationFrame(show);
    };

    /** @param {boolean} wanted */
    function setFollowed(wanted) {
      isFollowed = wanted;
      set(follow, { "aria-pressed": String(isFollowed) });
      soon();
    }

    /** @param {Vec2} share @returns {Vec2} */
    const spot = ([x, y]) => {
      const world = TILE * 2 ** look.zoom;
      return [
        (x - look.x) * world + canvas.clientWidth / 2,
        (y - look.y) * world + canvas.clientHeight / 2,
      ];
    };

    /** @param {{offsetX: number, offsetY: number}} event @returns {Vec2} */
    const shareAt = ({ offsetX, offsetY }) => {
      const world = TILE * 2 ** look.zoom;
      return [
        look.x + (offsetX - canvas.clientWidth / 2) / world,
        look.y + (offsetY - canvas.clientHeight / 2) / world,
      ];
    };

    function show() {
      request = 0;
      if (!canvas.clientWidth) return;
      const newest = tracks.find(({ track }) => track.newest)?.track.newest;
      const first = newest ? mercator(newest) : tracks.find(({ lines }) => lines.length)?.lines[0];
      if (first && !hasPlace) [look.zoom, hasPlace] = [FIRST, true];
      if (first && isFollowed) [look.x, look.y] = first;
      const { context, width, height } = fitted(canvas);
      const wanted = tilesOf(look, width, height);
      for (const [level, column, row] of wanted) drawTile(context, level, column, row);
      for (const [index, { track, lines }] of tracks.entries())
        drawTrack(context, index, track, lines);
      set(canvas, { "aria-label": `Map, level ${Math.round(look.zoom)}` });
      showPlace();
      if (hasPlace) ask(wanted);
    }

    /** The place under the pointer, which changes with the map, too. */
    function showPlace() {
      place.hidden = !pointer;
      if (!pointer) return;
      const [longitude, latitude] = unmercator(shareAt(pointer));
      setText(place, `${latitude.toFixed(6)}°, ${longitude.toFixed(6)}°`);
    }

    /** @param {[number, number, number][]} wanted */
    function ask(wanted) {
      const missing = wanted.filter((tile) => !tiles.has(tile.join("/")));
      const text = JSON.stringify(wanted);
      if (!address || !missing.length || text === asked) return;
      if (canvas.closest(".wv-locked")) return; // those of others are shown
      asked = text;
      clearTimeout(timer);
      timer = setTimeout(() => send(wanted), ASK_MS);
    }

    /**
     * A tile, or the part of one of a lower level until it is there.
     *
     * @param {CanvasRenderingContext2D} context
     * @param {number} level
     * @param {number} column
     * @param {number} row
     */
    function drawTile(context, level, column, row) {
      const size = TILE * 2 ** (look.zoom - level);
      const [x, y] = spot([column / 2 ** level, row / 2 ** level]);
      for (let up = 0; up <= DEEPER && up <= level; up++) {
        const image = tiles.get([level - up, column >> up, row >> up].join("/"));
        if (!image) continue;
        const part = image.width / 2 ** up;
        const [left, top] = [(column % 2 ** up) * part, (row % 2 ** up) * part];
        // Half a pixel more hides the seams.
        context.drawImage(image, left, top, part, part, x, y, size + 0.5, size + 0.5);
        return;
      }
    }

    /**
     * @param {CanvasRenderingContext2D} context
     * @param {number} index
     * @param {Track} track
     * @param {Vec2[]} lines
     */
    function drawTrack(context, index, track, lines) {
      context.strokeStyle = context.fillStyle = `hsl(${HUES[index % HUES.length]} 85% 50%)`;
      context.lineWidth = 3;
      context.lineJoin = "round";
      context.setLineDash(track.is_path ? [8, 5] : []);
      context.beginPath();
      for (const share of lines) context.lineTo(...spot(share));
      context.stroke();
      context.setLineDash([]);
      if (!track.newest) return;
      context.beginPath();
      context.arc(...spot(mercator(track.newest)), 6, 0, 2 * Math.PI);
      context.fill();
      context.strokeStyle = "#fff";
      context.lineWidth = 2;
      context.stroke();
    }

    /** @param {number} by @param {{offsetX: number, offsetY: number}} [at] */
    function zoom(by, at) {
      const middle = { offsetX: canvas.clientWidth / 2, offsetY: canvas.clientHeight / 2 };
      const [x, y] = shareAt(at ?? middle);
      look.zoom = Math.max(FURTHEST, Math.min(look.zoom + by, NEAREST));
      const [nextX, nextY] = shareAt(at ?? middle);
      [look.x, look.y] = [look.x + x - nextX, look.y + y - nextY];
      soon();
    }

    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      zoom(-event.deltaY * WHEEL_STEP, isFollowed ? undefined : event);
    });
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      canvas.setPointerCapture(event.pointerId);
      held = [event.clientX, event.clientY];
    });
    canvas.addEventListener("pointermove", (event) => {
      pointer = { offsetX: event.offsetX, offsetY: event.offsetY };
      if (!held) return showPlace();
      const world = TILE * 2 ** look.zoom;
      look.x -= (event.clientX - held[0]) / world;
      look.y -= (event.clientY - held[1]) / world;
      held = [event.clientX, event.clientY];
      setFollowed(false);
    });
    for (const end of /** @type {const} */ (["pointerup", "pointercancel"]))
      canvas.addEventListener(end, () => (held = null));
    canvas.addEventListener("pointerleave", () => {
      pointer = null;
      showPlace();
    });
    canvas.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.key === "+" || event.key === "=") zoom(1);
      else if (event.key === "-") zoom(-1);
      else if (event.key === "0") setFollowed(true);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
    const sizes = new ResizeObserver(soon);
    sizes.observe(canvas);

    /**
     * @param {string} name
     * @param {string} image as base64, "" without one
     */
    async function decode(name, image) {
      tiles.set(name, null);
      for (const old of tiles.keys()) {
        if (tiles.size <= MAX_TILES) break;
        tiles.get(old)?.close();
        tiles.delete(old);
        decodedOf.delete(old);
      }
      if (!image) return;
      const bytes = Uint8Array.from(atob(image), (letter) => letter.charCodeAt(0));
      try {
        tiles.set(name, await createImageBitmap(new Blob([bytes])));
      } catch {
        return; // the server has read it, the browser cannot
      }
      soon();
    }

    /**
     * @param {{address: string, credit: string, problem: string, tracks: Track[]}} values
     * @param {(key: string) => any} part
     */
    function update(values, part) {
      if (values.address !== address) {
        address = values.address;
        asked = "";
        tiles.clear();
        decodedOf.clear();
      }
      setText(problem, values.problem ?? "");
      set(problem, { hidden: !values.problem });
      setText(credit, values.credit ?? "");
      set(credit, { hidden: !values.credit });
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
      for (const tile of tilesOf(look, canvas.clientWidth, canvas.clientHeight)) {
        const name = tile.join("/");
        const found = part(`tile/${name}`);
        if (!found || decodedOf.get(name) === found.image) continue;
        decodedOf.set(name, found.image);
        decode(name, found.image);
      }
      soon();
    }

    setFollowed(true);
    return {
      element,
      update,
      close() {
        sizes.disconnect();
        clearTimeout(timer);
        cancelAnimationFrame(request);
        for (const image of tiles.values()) image?.close();
      },
    };
  });
}
