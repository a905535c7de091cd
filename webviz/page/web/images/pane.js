// A pane: the picture of one display, its title, and the value under the mouse.

import { el, set, showText } from "webviz/dom.js";
import { takeKeysOf } from "webviz/keys.js";
import { sanitized } from "webviz/sanitize.js";
import { recall, remember } from "webviz/remember.js";
import { makeCamera } from "webviz/images/camera.js";
import * as frames from "webviz/images/frames.js";
import { makeHead } from "webviz/images/pane_head.js";
import { makeLegend } from "webviz/images/pane_legend.js";
import { marksOver } from "webviz/images/pane_marks.js";
import { makePicture } from "webviz/images/picture.js";
import { makeReading } from "webviz/images/pixel_reading.js";
import { makeReadout } from "webviz/images/readout.js";
import { makeZoom, takeKey } from "webviz/images/zoom.js";

/** @import {PictureHeader} from "webviz/messages.js" */
/** @import {PaneCaption} from "webviz/contents.js" */

const RATE_MS = 1000;
const TEXT = "application/json";
const FULL = "wv-pane-full";

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
    ondblclick: () => (zoom.zoom() > 1 ? zoom.reset() : toggleFull()),
  });
  const zoom = makeZoom(canvas, zoomed);
  const picture = (withScene ? makeCamera : makePicture)(canvas, { drawn, fail });
  const head = makeHead({ toggle, toggleFull, unzoom: zoom.reset });
  const problem = el("div", { class: "wv-pane-problem" });
  const reading = makeReading(id, canvas, {
    picture,
    header: () => last,
    aboutAt: (mouse) => marks.textAt(mouse),
  });
  const legend = makeLegend();
  const content = [canvas, problem, reading.element, legend.element];
  const body = el("div", { class: "wv-pane-body" }, content);
  const marks = marksOver(canvas, body, { picture, zoom });
  const element = el("section", { class: "wv-pane", tabindex: -1 }, head.element, body);

  let title = "";
  let about = "";
  let isFolded = false;
  let said = "";
  let failed = "";
  /** @type {Partial<PictureHeader>} */
  let last = {};
  /** @type {number[]} */
  let times = [];
  let size = "";
  /** @type {ReturnType<typeof makeReadout> | null} */
  let readout = null;

  const isFull = () => element.classList.contains(FULL);

  function toggle() {
    isFolded = !isFolded;
    remember(`pane.${title}`, { ...recall(`pane.${title}`, {}), isFolded });
    if (isFolded) setFull(false);
    mark();
    changed();
  }

  function toggleFull() {
    setFull(!isFull());
    if (isFolded) toggle();
    changed();
  }

  /** @param {boolean} wanted */
  function setFull(wanted) {
    element.classList.toggle(FULL, wanted);
    if (wanted) element.focus(); // for Escape
    mark();
  }

  function zoomed() {
    head.showZoom(zoom.zoom());
    marks.redraw();
    frames.refresh(); // a larger picture has more to show
  }

  takeKeysOf(canvas, (event) => takeKey(zoom, event));
  takeKeysOf(element, (event) => {
    if (event.key !== "Escape" || !isFull()) return false;
    setFull(false);
    changed();
    return true;
  });

  function mark() {
    element.classList.toggle("wv-pane-folded", isFolded);
    head.update({ title, about, isFolded, isFull: isFull() });
    set(element, { "aria-label": `${readout ? "Text" : "Image"} ${title}` });
    set(canvas, { "aria-label": title });
    showText(problem, failed || said);
  }

  function tellRate() {
    if (readout) return head.tell(readout.facts());
    const now = performance.now();
    times = times.filter((time) => time > now - RATE_MS);
    const [width, height] = picture.size();
    head.tell(width && !isFolded ? `${width} × ${height} · ${times.length} Hz` : "");
  }
  const ticking = setInterval(tellRate, RATE_MS);

  function drawn() {
    times.push(performance.now());
    if (failed) fail("");
    if (picture.size().join() === size) return;
    size = picture.size().join();
    body.style.setProperty("--wv-aspect", picture.size().join(" / "));
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
      marks.show(header.marks ?? []);
      element.dataset.stamp = String(header.stamp);
      legend.show(header.legend);
      reading.read();
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
    head: head.element,
    isFolded: () => isFolded,
    title: () => title,
    /**
     * Shows it in the frame of a panel; returns what ends that.
     *
     * @param {HTMLElement} place
     * @param {HTMLElement} tools
     */
    openIn(place, tools) {
      if (isFolded) toggle();
      setFull(false);
      place.append(element);
      tools.append(...head.tools);
      const sizes = new ResizeObserver(frames.refresh);
      sizes.observe(element);
      return () => {
        sizes.disconnect();
        head.restore();
        changed();
      };
    },
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
      marks.close();
      reading.close();
      picture.close();
      readout?.close();
      frames.close(id);
    },
  };
}
