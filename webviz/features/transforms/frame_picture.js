// The tree of frames as a picture, in a dialog: moved by dragging, zoomed by the wheel, searched.

import { searchField } from "webviz/controls/fields.js";
import { contextOf, el, set } from "webviz/dom.js";
import { listenToPanning } from "webviz/panning.js";
import { openDialog } from "webviz/controls/dialog.js";
import { computed, effect, owned, root, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { oncePerFrame } from "webviz/timing.js";
import { wordsOf } from "webviz/words.js";
import { boxAt, draw, HEIGHT, layOut } from "webviz/features/transforms/frame_drawing.js";

/** @import {Readable, Signal} from "webviz/signals.js" */
/** @import {Box, Drawing, Look} from "webviz/features/transforms/frame_drawing.js" */

/** @typedef {((name: string) => boolean) | null} Matches which frames a search finds, null without one */

const FURTHEST = 0.02;
const NEAREST = 3;
const READABLE = 0.45; // of a scale; a tree that would be smaller begins at its root
const WHEEL_STEP = 0.002;
const KEY_STEP = 1.3;
const MOVE_PX = 60;
const CLICK_PX = 4;
const HINT = "Drag to pan, scroll to zoom, 0 to fit. Click a frame for details.";

const transforms = store("transforms");
const tree = store("frame_tree");

/**
 * Opens the dialog; `detailOf(name, frame)` is what it says of a frame.
 *
 * @param {(name: string, frame: any) => string} detailOf
 */
export const openFramePicture = (detailOf) =>
  root(async (end) => {
    const canvas = el("canvas", {
      class: "wv-frame-canvas",
      tabindex: 0,
      role: "img",
      autofocus: true,
    });
    const drawing = computed(() => drawingIn(contextOf(canvas)));
    const view = new View(canvas, () => drawing.value);
    const chosen = signal("");
    const { field, isFound } = searchIn(drawing, (box) => {
      chosen.value = box.name;
      view.centre(box);
    });
    paintInto(canvas, { drawing, view, isFound, chosen });
    listen(canvas, view, (x, y) => {
      chosen.value = (drawing.value && boxAt(drawing.value, x, y)?.name) ?? "";
    });
    const count = () => (drawing.value ? countText(drawing.value, isFound.value) : "");
    const detail = () =>
      chosen.value ? detailOf(chosen.value, transforms.get(chosen.value) ?? null) : HINT;
    await openDialog({
      title: "Transform tree",
      content: [
        el(
          "div",
          { class: "wv-search" },
          field,
          el("span", { class: "wv-quiet", role: "status" }, count),
        ),
        canvas,
        el("p", { class: "wv-frame-detail", role: "status" }, detail),
      ],
      className: "wv-frame-picture",
      isLight: true,
    });
    end();
  });

/**
 * The boxes and links of the tree as it is now, null before that is known; read in effects.
 *
 * @param {CanvasRenderingContext2D} context
 */
function drawingIn(context) {
  const places = tree.get("places");
  if (!places || !transforms.isThere()) return null;
  return layOut(context, places, tree.get("edges") ?? [], tree.get("rows") ?? 0, transforms.all());
}

/**
 * @param {Drawing} drawing
 * @param {Matches} isFound
 */
function countText({ boxes }, isFound) {
  if (isFound) return `${[...boxes.keys()].filter(isFound).length} of ${boxes.size}`;
  return `${boxes.size} frames, ${faultsIn(boxes)} in red`;
}

/** @param {Drawing["boxes"]} boxes */
const faultsIn = (boxes) => [...boxes.values()].filter(({ isFaulty }) => isFaulty).length;

/**
 * A field that finds frames, of which Enter shows one after another.
 *
 * @param {Readable<Drawing | null>} drawing
 * @param {(box: Box) => void} goTo
 */
function searchIn(drawing, goTo) {
  const text = signal("");
  const isFound = computed(() => {
    const words = wordsOf(text.value);
    /** @type {Matches} */
    const matches = (name) => words.every((word) => name.toLowerCase().includes(word));
    return words.length ? matches : null;
  });
  let hit = -1;

  /** @param {KeyboardEvent} event */
  function onkeydown(event) {
    if (event.key !== "Enter" || !drawing.value) return;
    event.preventDefault();
    const matches = isFound.value;
    const results = [...drawing.value.boxes.values()].filter(({ name }) => matches?.(name));
    if (!results.length) return;
    hit = (hit + (event.shiftKey ? -1 : 1) + results.length) % results.length;
    goTo(results[hit]);
  }

  const oninput = () => {
    hit = -1;
    text.value = field.value;
  };
  /** @type {HTMLInputElement} */
  const field = searchField("Find frames", oninput, { onkeydown });
  return { field, isFound };
}

/** The part of the drawing that is seen: all of it until the user moves or zooms. */
class View {
  #canvas;
  #drawing;
  #moved = signal(/** @type {Look | null} */ (null));
  #isBegun = false;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {() => Drawing | null} drawing
   */
  constructor(canvas, drawing) {
    this.#canvas = canvas;
    this.#drawing = drawing;
  }

  /** The look, to be read once there is a drawing and a size. */
  look() {
    if (!this.#isBegun) this.#begin();
    return this.#moved.value ?? this.#whole();
  }

  /** The view that the user has moved or zoomed to, null before; read in effects. */
  moved() {
    return this.#moved.value;
  }

  #whole() {
    const { width, height } = this.#drawing() ?? { width: 1, height: 1 };
    const { clientWidth, clientHeight } = this.#canvas;
    const fits = Math.min(clientWidth / width, clientHeight / height, 1);
    const scale = Math.max(FURTHEST, fits);
    return {
      x: (width - clientWidth / scale) / 2,
      y: (height - clientHeight / scale) / 2,
      scale,
    };
  }

  // A tree that would be too small to read begins at its root.
  #begin() {
    this.#isBegun = true;
    const [first] = this.#drawing()?.boxes.values() ?? [];
    if (!first || this.#whole().scale > READABLE) return;
    this.#moved.value = { x: 0, y: first.y - this.#canvas.clientHeight / 2, scale: 1 };
  }

  showAll() {
    this.#moved.value = null;
  }

  /**
   * Zooms, and keeps what is at a point of the canvas there.
   *
   * @param {number} factor
   * @param {number} atX
   * @param {number} atY
   */
  zoom(factor, atX = this.#canvas.clientWidth / 2, atY = this.#canvas.clientHeight / 2) {
    const { x, y, scale } = this.look();
    const next = Math.max(FURTHEST, Math.min(scale * factor, NEAREST));
    this.#moved.value = {
      x: x + atX / scale - atX / next,
      y: y + atY / scale - atY / next,
      scale: next,
    };
  }

  /**
   * @param {number} dx
   * @param {number} dy in pixels
   */
  move(dx, dy) {
    const { x, y, scale } = this.look();
    this.#moved.value = { x: x + dx / scale, y: y + dy / scale, scale };
  }

  /** @param {Box} box */
  centre({ x, y, width }) {
    const scale = Math.max(this.look().scale, 0.8);
    this.#moved.value = {
      x: x + width / 2 - this.#canvas.clientWidth / scale / 2,
      y: y + HEIGHT / 2 - this.#canvas.clientHeight / scale / 2,
      scale,
    };
  }
}

/**
 * Draws before the next frame whenever something has changed.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {{
 *   drawing: Readable<Drawing | null>, view: View, isFound: Readable<Matches>, chosen: Signal<string>,
 * }} picture
 */
function paintInto(canvas, { drawing, view, isFound, chosen }) {
  const redraw = oncePerFrame(() => {
    if (!drawing.value || !canvas.clientWidth) return;
    draw(canvas, drawing.value, view.look(), isFound.value, chosen.value);
  });
  effect(() => {
    const { boxes } = drawing.value ?? {};
    const label = `Tree of ${boxes?.size} frames, ${boxes && faultsIn(boxes)} of them with faults`;
    if (boxes) set(canvas, { "aria-label": label });
  });
  const inputs = computed(() => [drawing.value, view.moved(), isFound.value, chosen.value]);
  effect(() => {
    if (inputs.value) redraw();
  });
  const sizes = new ResizeObserver(redraw);
  sizes.observe(canvas);
  owned(() => sizes.disconnect());
}

/**
 * @param {HTMLCanvasElement} canvas
 * @param {View} view
 * @param {(x: number, y: number) => void} choose gets a place of the drawing
 */
function listen(canvas, view, choose) {
  listenToPanning(canvas, {
    wheel: ({ deltaY, offsetX, offsetY }) =>
      view.zoom(2 ** (-deltaY * WHEEL_STEP), offsetX, offsetY),
    move: (dx, dy) => view.move(-dx, -dy),
    keys: {
      ArrowLeft: () => view.move(-MOVE_PX, 0),
      ArrowRight: () => view.move(MOVE_PX, 0),
      ArrowUp: () => view.move(0, -MOVE_PX),
      ArrowDown: () => view.move(0, MOVE_PX),
      "+": () => view.zoom(KEY_STEP),
      "=": () => view.zoom(KEY_STEP),
      "-": () => view.zoom(1 / KEY_STEP),
      0: () => view.showAll(),
    },
    click({ offsetX, offsetY }) {
      const { x, y, scale } = view.look();
      choose(x + offsetX / scale, y + offsetY / scale);
    },
    slack: CLICK_PX,
  });
}
