// A pane: the picture of one display, what it is called, and what is under the mouse.

import * as channel from "../channel.js";
import { fitted } from "../charts/canvas.js";
import { el, set, setText } from "../dom.js";
import { icon } from "../icons.js";
import { sanitized } from "../sanitize.js";
import { recall, remember } from "../remember.js";
import { makeCamera } from "./camera.js";
import * as frames from "./frames.js";
import { drawMarks, markAt } from "./marks.js";
import { makePicture } from "./picture.js";
import { pixelText } from "./pixel_text.js";
import { makeReadout } from "./readout.js";
import { makeZoom } from "./zoom.js";

/** @import {ColorRange, PictureHeader, PixelValue} from "../messages.js" */
/** @import {PaneCaption} from "../contents.js" */
/** @import {Vec2} from "../types.js" */
/** @import {Places} from "./marks.js" */

const READ_MS = 100;
const RATE_MS = 1000;
const TEXT = "application/json";

/** @type {Map<string, (value: PixelValue) => void>} */
const readers = new Map();
channel.on("PixelValue", (value) => readers.get(value.display)?.(value));

/**
 * The pane of a display; `changed()` is called when it takes more or less room. One `withScene` draws
 * the scene, too.
 *
 * @param {string} id
 * @param {() => void} changed
 * @param {boolean} withScene
 */
export function makePane(id, changed, withScene) {
  const canvas = el("canvas", {
    class: "wv-pane-picture",
    role: "img",
    tabindex: 0,
    ondblclick: onDouble,
  });
  const zoom = makeZoom(canvas, zoomed);
  const picture = (withScene ? makeCamera : makePicture)(canvas, { drawn, fail });
  const name = el("b");
  const facts = el("span", { class: "wv-quiet" });
  const problem = el("div", { class: "wv-pane-problem" });
  const value = el("div", { class: "wv-pane-value" });
  const bar = el("div", { class: "wv-legend-bar" });
  const bounds = [el("span"), el("span")];
  const legend = el("div", { class: "wv-pane-legend", hidden: true }, bounds[0], bar, bounds[1]);
  const fold = el(
    "button",
    { class: "wv-icon wv-pane-fold", type: "button", onclick: toggle },
    icon("chevron"),
  );
  const unzoom = el("button", {
    class: "wv-button wv-pane-zoom",
    type: "button",
    hidden: true,
    onclick: zoom.reset,
  });
  const full = el(
    "button",
    { class: "wv-icon", type: "button", onclick: toggleFull },
    icon("fullscreen"),
  );
  const head = el("header", { class: "wv-pane-head" }, fold, name, facts, unzoom, full);
  const overlay = el("canvas", { class: "wv-pane-marks" });
  const body = el("div", { class: "wv-pane-body" }, canvas, problem, value, legend);
  const element = el("section", { class: "wv-pane", tabindex: -1 }, head, body);

  let title = "";
  let about = "";
  let isFolded = false;
  let said = "";
  let failed = "";
  /** @type {{clientX: number, clientY: number} | null} */
  let mouse = null;
  /** @type {Partial<PictureHeader>} */
  let last = {};
  let asked = 0;
  let later = 0;
  /** @type {number[]} */
  let times = [];
  /** @type {string | null} */
  let scale = null;
  let size = "";
  /** @type {ReturnType<typeof makeReadout> | null} */
  let readout = null;

  function toggle() {
    isFolded = !isFolded;
    remember(`pane.${title}`, { ...recall(`pane.${title}`, {}), isFolded });
    if (isFolded) setFull(false);
    mark();
    changed();
  }

  function toggleFull() {
    setFull(!element.classList.contains("wv-pane-full"));
    if (isFolded) toggle();
    changed();
  }

  function onDouble() {
    if (zoom.zoom() > 1) zoom.reset();
    else toggleFull();
  }

  function zoomed() {
    unzoom.hidden = zoom.zoom() === 1;
    setText(unzoom, `${zoom.zoom().toFixed(1)}×`);
    showMarks();
    frames.refresh(); // a larger picture has more to show
  }

  /** @param {boolean} wanted */
  function setFull(wanted) {
    element.classList.toggle("wv-pane-full", wanted);
    if (wanted) element.focus(); // for Escape
    mark();
  }

  canvas.addEventListener("keydown", (event) => {
    if (!zoom.key(event)) return;
    event.preventDefault();
    event.stopPropagation(); // viser's camera turns by arrow keys
  });
  element.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !element.classList.contains("wv-pane-full")) return;
    event.stopPropagation();
    setFull(false);
    changed();
  });

  function mark() {
    const isFull = element.classList.contains("wv-pane-full");
    element.classList.toggle("wv-pane-folded", isFolded);
    set(fold, {
      "aria-expanded": String(!isFolded),
      "aria-label": `${isFolded ? "Expand" : "Collapse"} ${title}`,
    });
    set(full, {
      "aria-pressed": String(isFull),
      "aria-label": `Full size of ${title}`,
      "data-tip": isFull ? "Leave full size (Esc)" : "Full size",
    });
    set(element, { "aria-label": `${readout ? "Text" : "Image"} ${title}` });
    set(canvas, { "aria-label": title });
    set(unzoom, {
      "aria-label": `Reset the zoom of ${title}`,
      "data-tip": "Reset the zoom (double click)",
    });
    set(name, { "data-tip": about });
    setText(name, title);
    setText(problem, failed || said);
    problem.hidden = !(failed || said);
  }

  function tellRate() {
    if (readout) return setText(facts, readout.facts());
    const now = performance.now();
    times = times.filter((time) => time > now - RATE_MS);
    const [width, height] = picture.size();
    const facts_ = width && !isFolded ? `${width} × ${height} · ${times.length} Hz` : "";
    setText(facts, facts_);
  }
  const ticking = setInterval(tellRate, RATE_MS);

  /** @param {ColorRange | undefined} wanted */
  function showLegend(wanted) {
    legend.hidden = !wanted;
    if (!wanted) return;
    const { low, high, unit, colors } = wanted;
    setText(bounds[0], `${low}${unit && ` ${unit}`}`);
    setText(bounds[1], `${high}${unit && ` ${unit}`}`);
    const stops = colors.map((rgb) => `rgb(${rgb.join()})`).join();
    if (stops !== scale) bar.style.background = `linear-gradient(to right, ${stops})`;
    scale = stops;
  }

  /** @returns {Places} of the pixels of the picture in the body. */
  function places() {
    const { clientWidth, clientHeight } = body;
    const { at, scale } = picture.placeIn(clientWidth, clientHeight);
    const [zoomed, [left, top]] = [zoom.zoom(), zoom.corner()];
    return {
      width: clientWidth,
      scale: scale * zoomed,
      at(x, y) {
        const [across, down] = at(x, y);
        return [left * clientWidth + zoomed * across, top * clientHeight + zoomed * down];
      },
    };
  }

  function showMarks() {
    const marks = last.marks ?? [];
    if (!marks.length) return overlay.remove();
    if (!overlay.isConnected) canvas.after(overlay);
    if (!body.clientWidth || !picture.size()[0]) return;
    drawMarks(fitted(overlay).context, marks, places());
  }
  const resized = new ResizeObserver(showMarks);
  resized.observe(body);

  /** The text about the mark under the mouse. */
  function aboutMark() {
    if (!mouse || !last.marks?.length) return "";
    const box = body.getBoundingClientRect();
    return markAt(last.marks, places(), [mouse.clientX - box.left, mouse.clientY - box.top]);
  }

  function read() {
    const pixel = mouse && picture.pixelAt(mouse);
    if (pixel && value.hidden) tell(pixel, "");
    value.hidden = !pixel;
    if (!pixel) return;
    if (!last.readable) return tell(pixel, pixelText(picture.colorAt(pixel), last.legend));
    const now = performance.now();
    clearTimeout(later);
    if (now - asked < READ_MS) {
      later = setTimeout(read, asked + READ_MS - now); // else a mouse that rests has an old value
      return;
    }
    asked = now;
    channel.send({ type: "ReadPixel", display: id, x: pixel[0], y: pixel[1] });
  }

  /**
   * @param {Vec2} pixel
   * @param {string} text
   */
  const tell = ([x, y], text) =>
    setText(value, [`x ${x} · y ${y}`, text, aboutMark()].filter(Boolean).join(" · "));
  readers.set(id, ({ x, y, text }) => mouse && tell([x, y], text));
  canvas.addEventListener("pointermove", (event) => {
    mouse = { clientX: event.clientX, clientY: event.clientY };
    read();
  });
  canvas.addEventListener("pointerleave", () => {
    mouse = null;
    value.hidden = true;
  });
  value.hidden = true;

  function drawn() {
    times.push(performance.now());
    if (failed) fail("");
    if (picture.size().join() === size) return;
    size = picture.size().join();
    tellRate();
    frames.refresh();
  }

  /** @param {string} sentence */
  function fail(sentence) {
    failed = sentence;
    mark();
  }

  /**
   * @param {PictureHeader} header
   * @param {Uint8Array<ArrayBuffer>} data
   */
  async function take(header, data) {
    try {
      if (header.mime === TEXT) return takeText(header, data);
      await picture.take(header, data);
      last = header;
      showMarks();
      element.dataset.stamp = String(header.stamp);
      showLegend(header.legend);
      read();
    } catch (error) {
      fail(error instanceof Error ? error.message : String(error));
    }
  }

  /**
   * @param {PictureHeader} header
   * @param {Uint8Array<ArrayBuffer>} data
   */
  function takeText(header, data) {
    if (!readout) {
      readout = makeReadout(body, id);
      element.classList.add("wv-pane-text");
      mark();
    }
    readout.take(header, data);
    element.dataset.stamp = String(header.stamp);
    tellRate();
  }

  frames.open(id, {
    width: () =>
      isFolded
        ? 0
        : readout
          ? body.clientWidth
          : canvas.clientWidth && zoom.zoom() * picture.width(),
    take,
  });
  return {
    element,
    isFolded: () => isFolded,
    /** @param {PaneCaption} row */
    update(row) {
      const wanted = sanitized(row.title, 200);
      if (wanted !== title)
        isFolded = recall(`pane.${wanted}`, { isFolded: false }).isFolded ?? false;
      title = wanted;
      about = [sanitized(row.name, 100), wanted].join("\n");
      said = sanitized(row.problem);
      picture.hide?.(row.hidden ?? []);
      element.classList.toggle("wv-pane-empty", !row.has_picture);
      mark();
    },
    close() {
      clearInterval(ticking);
      resized.disconnect();
      readers.delete(id);
      picture.close();
      readout?.close();
      frames.close(id);
    },
  };
}
