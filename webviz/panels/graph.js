// The widget "graph": nodes and topics as boxes, from those that send to those that receive.

import { fitted } from "webviz/charts/canvas.js";
import { el, set, setText, showText, svgElement } from "webviz/dom.js";
import { download } from "webviz/download.js";
import { iconButton } from "webviz/icons.js";
import { listenToPanning } from "webviz/panning.js";
import { about } from "./graph_detail.js";
import { draw, svgOf } from "./graph_drawing.js";
import { boxesOf, foldable, layOut } from "./graph_layout.js";
import { makeSearch } from "./graph_search.js";
import { boxAt, centred, foldsOf, rateText, sumText, whole, zoomed } from "./graph_view.js";

/** @import {Page} from "../page/web/extensions.js" */
/** @import {Topic} from "./graph_layout.js" */
/** @import {Look, RateOf} from "./graph_view.js" */

const FOLD_ABOVE = 60; // boxes
const WHEEL_STEP = 0.002;
const KEY_STEP = 1.3;
const CLICK_PX = 4;

/** @param {Page} page */
export default function install(page) {
  page.widget("graph", () => graph(page));
}

/** @param {Page} page */
function graph({ watch }) {
  /** @type {Topic[]} */
  let topics = [];
  let given = ""; // of which topics the drawing is
  /** @type {Set<string>} */
  const opened = new Set(); // namespaces
  let drawing = layOut([], () => false);
  /** @type {Look | null} */
  let moved = null; // null until somebody moves or zooms: all is in sight
  let chosen = "";
  let request = 0;
  /** @type {Map<string, number>} */
  let rates = new Map();
  /** @type {(() => void) | null} */
  let unmeasure = null;

  const empty = el("div", { class: "wv-empty", role: "status" });
  const canvas = el("canvas", { class: "wv-graph-canvas", role: "img", tabindex: 0 });
  const search = makeSearch({
    boxes: () => drawing.boxes.values(),
    changed: soon,
    goTo(box) {
      look(centred(seen(), box, size()));
      choose(box.key);
    },
  });
  const count = el("span", { class: "wv-quiet", role: "status" });
  const detail = el("div", { class: "wv-plugin-detail wv-graph-detail", hidden: true });
  const bar = [
    search.element,
    iconButton("fold", "Fold or unfold all namespaces", foldAll),
    iconButton("focus", "Show all (0)", () => look(null)),
    iconButton("download", "Download as SVG", () => download("graph.svg", picture())),
  ];

  const size = () => ({ width: canvas.clientWidth, height: canvas.clientHeight });
  const seen = () => moved ?? whole(drawing, size());
  /** @type {RateOf} */
  const rateOf = (names) => rateText([...names].flatMap((name) => rates.get(name) ?? []));

  function soon() {
    request ||= requestAnimationFrame(show);
  }

  /** @param {Look | null} next */
  function look(next) {
    moved = next;
    soon();
  }

  /** @param {number} factor @param {number} [x] @param {number} [y] */
  const zoom = (factor, x = canvas.clientWidth / 2, y = canvas.clientHeight / 2) =>
    look(zoomed(seen(), factor, x, y));

  function arrange() {
    drawing = layOut(topics, (namespace) => !opened.has(namespace));
    soon();
  }

  function show() {
    request = 0;
    if (!canvas.clientWidth) return;
    const isFound = search.isFound();
    const sum = sumText(drawing, isFound);
    setText(count, sum);
    set(canvas, { "aria-label": `Graph: ${sum}` });
    const { context, width, height, color } = fitted(canvas);
    draw(context, drawing, { look: seen(), width, height, color, isFound, chosen, rateOf });
  }

  /** @param {string} key */
  function choose(key) {
    const box = drawing.boxes.get(key);
    chosen = box ? key : "";
    unmeasure?.();
    unmeasure = null;
    set(detail, { hidden: !box });
    soon();
    if (!box) return;
    // The message of a topic that a page shows is subscribed to, and so has a rate.
    if (box.kind === "topic") unmeasure = watch(`message:${box.name}`, () => {});
    const folds = foldsOf(box, foldable(topics), opened);
    const { links } = drawing;
    detail.replaceChildren(...about(box, { links, folds, toggle, close: () => choose("") }));
  }

  /** @param {string} namespace */
  function toggle(namespace) {
    if (!opened.delete(namespace)) opened.add(namespace);
    arrange();
    choose("");
  }

  function foldAll() {
    const all = foldable(topics);
    const isFolded = opened.size < all.size;
    opened.clear();
    if (isFolded) for (const name of all) opened.add(name);
    arrange();
  }

  function picture() {
    /** @param {string} name */
    const color = (name) => getComputedStyle(canvas).getPropertyValue(`--wv-${name}`);
    return svgOf(drawing, { color, rateOf, svgElement });
  }

  /** @param {MouseEvent} event */
  const at = ({ offsetX, offsetY }) => boxAt(drawing.boxes, seen(), offsetX, offsetY);
  listenToPanning(canvas, {
    wheel: ({ deltaY, offsetX, offsetY }) => zoom(2 ** (-deltaY * WHEEL_STEP), offsetX, offsetY),
    move(dx, dy) {
      const { x, y, scale } = seen();
      look({ x: x - dx / scale, y: y - dy / scale, scale });
    },
    keys: {
      "+": () => zoom(KEY_STEP),
      "=": () => zoom(KEY_STEP),
      "-": () => zoom(1 / KEY_STEP),
      0: () => look(null),
    },
    click: (event) => choose(at(event)?.key ?? ""),
    slack: CLICK_PX,
  });
  canvas.addEventListener("dblclick", (event) => {
    const box = at(event);
    if (box?.kind === "group") toggle(box.name);
  });
  const sizes = new ResizeObserver(soon);
  sizes.observe(canvas);
  const unwatch = watch("traffic", (all) => {
    rates = new Map([...all].map(([name, { hz }]) => [name, hz]));
    soon();
  });

  /**
   * @param {{parts: number, problem: string}} values
   * @param {(key: string) => {topics: Topic[]} | undefined} part
   */
  function update({ parts = 0, problem = "" }, part) {
    showText(empty, problem);
    const next = Array.from({ length: parts }, (_, i) => part(String(i))?.topics ?? []).flat();
    const text = JSON.stringify(next);
    if (text === given) return;
    const isFirst = given === "" && next.length > 0;
    given = text;
    topics = next;
    if (isFirst && boxesOf(topics, () => false).boxes.size <= FOLD_ABOVE)
      for (const name of foldable(topics)) opened.add(name);
    arrange();
    if (chosen) choose(chosen);
  }

  const element = el("div", { class: "wv-plugin-fill" }, empty, canvas, detail);
  return {
    element,
    head: el("span", { class: "wv-panel-tools" }, count, bar),
    update,
    close() {
      unmeasure?.();
      unwatch();
      sizes.disconnect();
      cancelAnimationFrame(request);
    },
  };
}
