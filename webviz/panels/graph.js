// The widget "graph": nodes and topics as boxes, from those that send to those that receive.

import { fitted } from "webviz/charts/canvas.js";
import { el, svgElement } from "webviz/dom.js";
import { download } from "webviz/download.js";
import { iconButton } from "webviz/icons.js";
import { listenToPanning } from "webviz/panning.js";
import { computed, effect, owned, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { oncePerFrame } from "webviz/timing.js";
import { about } from "./graph_detail.js";
import { draw, svgOf } from "./graph_drawing.js";
import { boxesOf, foldable, layOut } from "./graph_layout.js";
import { makeSearch } from "./graph_search.js";
import { boxAt, centred, foldsOf, rateText, sumText, whole, zoomed } from "./graph_view.js";

/** @import {Page} from "../page/web/extensions.js" */
/** @import {Readable} from "../page/web/signals.js" */
/** @import {Box, Drawing, Topic} from "./graph_layout.js" */
/** @import {Look, RateOf} from "./graph_view.js" */

const FOLD_ABOVE = 60; // boxes
const WHEEL_STEP = 0.002;
const KEY_STEP = 1.3;
const CLICK_PX = 4;

const traffic = store("traffic");

/** @param {Page} page */
export default function install(page) {
  page.widget("graph", graph);
}

function graph() {
  const json = signal("[]"); // topics as JSON: most updates change nothing
  const problem = signal("");
  const model = modelOf(computed(() => /** @type {Topic[]} */ (JSON.parse(json.value))));
  const { canvas } = model.view;
  effect(() => canvas.setAttribute("aria-label", `Graph: ${model.sum()}`));
  paintInto(canvas, model.picture, ({ context, width, height, color }) => {
    const look = model.view.current();
    draw(context, model.drawing.value, { ...model.picture.value, look, width, height, color });
  });
  listenToBoxes(canvas, model.view, model);
  return {
    element: el(
      "div",
      { class: "wv-plugin-fill" },
      el("div", { class: "wv-empty", role: "status", hidden: () => !problem.value }, problem),
      canvas,
      detail(model),
    ),
    head: head(model),
    /**
     * @param {{parts: number, problem: string}} values
     * @param {(key: string) => {topics: Topic[]} | undefined} part
     */
    update(values, part) {
      problem.value = values.problem ?? "";
      const numbers = Array.from({ length: values.parts ?? 0 }, (_, i) => String(i));
      json.value = JSON.stringify(numbers.flatMap((number) => part(number)?.topics ?? []));
    },
  };
}

/** @typedef {ReturnType<typeof modelOf>} Model */

/**
 * The boxes of topics, those that were found and chosen, and what is seen of them.
 *
 * @param {Readable<Topic[]>} topics
 */
function modelOf(topics) {
  const folding = foldings(topics);
  const drawing = computed(() => layOut(topics.value, folding.isFolded()));
  const chosen = choice(() => drawing.value.boxes);
  const view = looks(() => drawing.value);
  const rates = computed(() => new Map([...traffic.all()].map(([name, { hz }]) => [name, hz])));
  const search = makeSearch({
    boxes: () => drawing.value.boxes.values(),
    goTo(box) {
      view.centre(box);
      chosen.key.value = box.key;
    },
  });
  /** @type {RateOf} */
  const rateOf = (names) => rateText([...names].flatMap((name) => rates.value.get(name) ?? []));
  const picture = computed(() => ({
    ...{ look: view.moved.value, rateOf: rates.value && rateOf },
    ...{ drawing: drawing.value, isFound: search.isFound(), chosen: chosen.key.value },
  }));
  return {
    ...{ topics, folding, drawing, chosen, view, search, rateOf, picture },
    sum: () => sumText(drawing.value, search.isFound()),
    /** @param {MouseEvent} event */
    boxAt: ({ offsetX, offsetY }) => boxAt(drawing.value.boxes, view.current(), offsetX, offsetY),
    /** @param {Box | null | undefined} box */
    choose: (box) => (chosen.key.value = box?.key ?? ""),
    /** @param {string} namespace */
    toggle(namespace) {
      folding.toggle(namespace);
      chosen.key.value = "";
    },
  };
}

/** @param {Model} model */
function head({ sum, search, folding, view, drawing, rateOf }) {
  const save = () => download("graph.svg", svgOf(drawing.value, pens(view.canvas, rateOf)));
  return el(
    "span",
    { class: "wv-panel-tools" },
    el("span", { class: "wv-quiet", role: "status" }, sum),
    search.element,
    iconButton("fold", "Fold or unfold all namespaces", folding.toggleAll),
    iconButton("focus", "Show all (0)", view.showAll),
    iconButton("download", "Download as SVG", save),
  );
}

/**
 * What is known of the chosen box.
 *
 * @param {Model} model
 */
function detail({ chosen, drawing, topics, folding, toggle, choose }) {
  const parts = () => {
    const box = chosen.box.value;
    if (!box) return [];
    const folds = foldsOf(box, foldable(topics.value), folding.opened.value);
    return about(box, { links: drawing.value.links, folds, toggle, close: () => choose(null) });
  };
  const hidden = () => !chosen.box.value;
  return el("div", { class: "wv-plugin-detail wv-graph-detail", hidden }, parts);
}

/**
 * The namespaces that are unfolded: all at first, if there are few boxes.
 *
 * @param {Readable<Topic[]>} topics
 */
function foldings(topics) {
  const opened = signal(/** @type {Set<string>} */ (new Set()));
  let isNew = true;
  effect(() => {
    const all = topics.value;
    if (!isNew || !all.length) return;
    isNew = false;
    if (boxesOf(all, () => false).boxes.size <= FOLD_ABOVE) opened.value = foldable(all);
  });
  return {
    opened,
    isFolded() {
      const open = opened.value;
      return (/** @type {string} */ namespace) => !open.has(namespace);
    },
    /** @param {string} namespace */
    toggle(namespace) {
      const next = new Set(opened.value);
      if (!next.delete(namespace)) next.add(namespace);
      opened.value = next;
    },
    toggleAll() {
      const all = foldable(topics.value);
      opened.value = opened.value.size < all.size ? all : new Set();
    },
  };
}

/**
 * The box that was chosen, until it is gone.
 *
 * @param {() => Map<string, Box>} boxes
 */
function choice(boxes) {
  const key = signal("");
  const box = computed(() => boxes().get(key.value) ?? null);
  effect(() => {
    if (!box.value) key.value = "";
    // The message of a topic that a page shows is subscribed to, and so has a rate.
    else if (box.value.kind === "topic") store(`message:${box.value.name}`).all();
  });
  return { key, box };
}

/**
 * The canvas, and the part of the drawing that is seen in it: all until the user moves or zooms.
 *
 * @param {() => Drawing} drawing
 */
function looks(drawing) {
  const canvas = el("canvas", { class: "wv-graph-canvas", role: "img", tabindex: 0 });
  const moved = signal(/** @type {Look | null} */ (null));
  const size = () => ({ width: canvas.clientWidth, height: canvas.clientHeight });
  const current = () => moved.value ?? whole(drawing(), size());
  return {
    canvas,
    moved,
    current,
    showAll: () => (moved.value = null),
    /** @param {Box} box */
    centre: (box) => (moved.value = centred(current(), box, size())),
    /** @param {number} dx @param {number} dy in pixels */
    move(dx, dy) {
      const { x, y, scale } = current();
      moved.value = { x: x - dx / scale, y: y - dy / scale, scale };
    },
    /** @param {number} factor @param {number} [x] @param {number} [y] */
    zoom(factor, x = canvas.clientWidth / 2, y = canvas.clientHeight / 2) {
      moved.value = zoomed(current(), factor, x, y);
    },
  };
}

/**
 * Draws into a canvas before the next frame whenever a picture is another, or its size.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {Readable<object>} picture
 * @param {(sheet: ReturnType<typeof fitted>) => void} paint
 */
function paintInto(canvas, picture, paint) {
  const redraw = oncePerFrame(() => canvas.clientWidth && paint(fitted(canvas)));
  effect(() => {
    if (picture.value) redraw();
  });
  const sizes = new ResizeObserver(redraw);
  sizes.observe(canvas);
  owned(() => sizes.disconnect());
}

/**
 * Listens to drags, the wheel, keys and clicks.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {Pick<ReturnType<typeof looks>, "zoom" | "move" | "showAll">} view
 * @param {Pick<Model, "boxAt" | "choose" | "toggle">} boxes
 */
function listenToBoxes(canvas, { zoom, move, showAll }, { boxAt, choose, toggle }) {
  listenToPanning(canvas, {
    wheel: ({ deltaY, offsetX, offsetY }) => zoom(2 ** (-deltaY * WHEEL_STEP), offsetX, offsetY),
    move,
    keys: {
      "+": () => zoom(KEY_STEP),
      "=": () => zoom(KEY_STEP),
      "-": () => zoom(1 / KEY_STEP),
      0: showAll,
    },
    click: (event) => choose(boxAt(event)),
    slack: CLICK_PX,
  });
  canvas.addEventListener("dblclick", (event) => {
    const box = boxAt(event);
    if (box?.kind === "group") toggle(box.name);
  });
}

/**
 * What draws as SVG in the colours of the canvas.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {RateOf} rateOf
 */
const pens = (canvas, rateOf) => ({
  color: (/** @type {string} */ name) => getComputedStyle(canvas).getPropertyValue(`--wv-${name}`),
  rateOf,
  svgElement,
});
