// The tree of frames as a picture, in a dialog: moved by dragging, zoomed by the wheel, searched.

import { searchField } from "webviz/controls/fields.js";
import { el, set, setText } from "webviz/dom.js";
import { listenToPanning } from "webviz/panning.js";
import { openDialog } from "webviz/controls/dialog.js";
import { watch } from "webviz/stores.js";
import { wordsOf } from "webviz/words.js";
import { boxAt, draw, HEIGHT, layOut } from "webviz/features/transforms/frame_drawing.js";

/** @import {ValuesOf} from "webviz/types.js" */
/** @import {Box, Drawing, Look} from "webviz/features/transforms/frame_drawing.js" */

const FURTHEST = 0.02;
const NEAREST = 3;
const READABLE = 0.45; // of a scale; a tree that would be smaller begins at its root
const WHEEL_STEP = 0.002;
const KEY_STEP = 1.3;
const MOVE_PX = 60;
const CLICK_PX = 4;
const HINT = "Drag to pan, scroll to zoom, 0 to fit. Click a frame for details.";

/**
 * Opens the dialog; `detailOf(name, frame)` is what it says of a frame.
 *
 * @param {(name: string, frame: any) => string} detailOf
 */
export async function openFramePicture(detailOf) {
  /** @type {ValuesOf<"transforms"> | null} */
  let values = null;
  /** @type {ValuesOf<"frame_tree"> | null} */
  let tree = null;
  /** @type {Drawing | null} */
  let drawing = null;
  /** @type {Look} */
  const look = { x: 0, y: 0, scale: 1 };
  let isWhole = true; // follows the window until somebody moves or zooms
  let isBegun = false;
  let chosen = "";
  let hit = -1;
  let request = 0;

  const canvas = el("canvas", {
    class: "wv-frame-canvas",
    tabindex: 0,
    role: "img",
    autofocus: true,
  });
  const search = searchField("Find frames", () => ((hit = -1), soon()), { onkeydown: onSearchKey });
  const count = el("span", { class: "wv-quiet", role: "status" });
  const detail = el("p", { class: "wv-frame-detail", role: "status" }, HINT);

  function soon() {
    request ||= requestAnimationFrame(show);
  }

  function show() {
    request = 0;
    const context = canvas.getContext("2d");
    const places = tree?.get("places");
    if (!context || !values || !tree || !places || !canvas.clientWidth) return;
    drawing ??= layOut(context, places, tree.get("edges") ?? [], tree.get("rows") ?? 0, values);
    if (!isBegun) begin(drawing);
    if (isWhole) fit(drawing);
    const words = wordsOf(search.value);
    /** @param {string} name */
    const isFound = (name) => words.every((word) => name.toLowerCase().includes(word));
    const found = words.length ? [...drawing.boxes.keys()].filter(isFound) : [];
    const faults = [...drawing.boxes.values()].filter(({ isFaulty }) => isFaulty).length;
    const total = drawing.boxes.size;
    setText(
      count,
      words.length ? `${found.length} of ${total}` : `${total} frames, ${faults} in red`,
    );
    set(canvas, { "aria-label": `Tree of ${total} frames, ${faults} of them with faults` });
    draw(canvas, drawing, look, words.length ? isFound : null, chosen);
    if (chosen) setText(detail, detailOf(chosen, values.get(chosen) ?? null));
  }

  function showAll() {
    isWhole = true;
    soon();
  }

  /** @param {Drawing} whole */
  function fit({ width, height }) {
    const scale = Math.min(canvas.clientWidth / width, canvas.clientHeight / height, 1);
    look.scale = Math.max(FURTHEST, scale);
    look.x = (width - canvas.clientWidth / look.scale) / 2;
    look.y = (height - canvas.clientHeight / look.scale) / 2;
  }

  /** @param {Drawing} whole */
  function begin(whole) {
    isBegun = true;
    fit(whole);
    const [root] = whole.boxes.values();
    if (!root || look.scale > READABLE) return;
    isWhole = false;
    Object.assign(look, { x: 0, y: root.y - canvas.clientHeight / 2, scale: 1 });
  }

  /**
   * Zooms, and keeps what is at a point of the canvas there.
   *
   * @param {number} factor
   * @param {number} atX
   * @param {number} atY
   */
  function zoom(factor, atX = canvas.clientWidth / 2, atY = canvas.clientHeight / 2) {
    const next = Math.max(FURTHEST, Math.min(look.scale * factor, NEAREST));
    look.x += atX / look.scale - atX / next;
    look.y += atY / look.scale - atY / next;
    look.scale = next;
    isWhole = false;
    soon();
  }

  /**
   * @param {number} dx
   * @param {number} dy
   */
  function move(dx, dy) {
    look.x += dx / look.scale;
    look.y += dy / look.scale;
    isWhole = false;
    soon();
  }

  /** @param {Box} box */
  function goTo({ name, x, y, width }) {
    chosen = name;
    look.scale = Math.max(look.scale, 0.8);
    look.x = x + width / 2 - canvas.clientWidth / look.scale / 2;
    look.y = y + HEIGHT / 2 - canvas.clientHeight / look.scale / 2;
    isWhole = false;
    soon();
  }

  /** @param {KeyboardEvent} event */
  function onSearchKey(event) {
    if (event.key !== "Enter" || !drawing) return;
    event.preventDefault();
    const words = wordsOf(search.value);
    const all = [...drawing.boxes.values()];
    const found = all.filter(({ name }) =>
      words.every((word) => name.toLowerCase().includes(word)),
    );
    if (!words.length || !found.length) return;
    hit = (hit + (event.shiftKey ? -1 : 1) + found.length) % found.length;
    goTo(found[hit]);
  }

  /** @param {PointerEvent} event */
  function choose(event) {
    if (!drawing) return;
    const [x, y] = [look.x + event.offsetX / look.scale, look.y + event.offsetY / look.scale];
    chosen = boxAt(drawing, x, y)?.name ?? "";
    if (!chosen) setText(detail, HINT);
    soon();
  }

  listenToPanning(canvas, {
    wheel: ({ deltaY, offsetX, offsetY }) => zoom(2 ** (-deltaY * WHEEL_STEP), offsetX, offsetY),
    move: (dx, dy) => move(-dx, -dy),
    keys: {
      ArrowLeft: () => move(-MOVE_PX, 0),
      ArrowRight: () => move(MOVE_PX, 0),
      ArrowUp: () => move(0, -MOVE_PX),
      ArrowDown: () => move(0, MOVE_PX),
      "+": () => zoom(KEY_STEP),
      "=": () => zoom(KEY_STEP),
      "-": () => zoom(1 / KEY_STEP),
      0: showAll,
    },
    click: choose,
    slack: CLICK_PX,
  });

  const sizes = new ResizeObserver(soon);
  sizes.observe(canvas);
  const ends = [
    watch("transforms", (all) => ((values = all), (drawing = null), soon())),
    watch("frame_tree", (all) => ((tree = all), (drawing = null), soon())),
  ];
  const head = el("div", { class: "wv-search" }, search, count);
  await openDialog({
    title: "Transform tree",
    content: [head, canvas, detail],
    className: "wv-frame-picture",
    isLight: true,
  });
  for (const end of ends) end();
  sizes.disconnect();
  cancelAnimationFrame(request);
}
