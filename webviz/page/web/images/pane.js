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

/** The pane of a display. */
export class Pane {
  #id;
  #changed;
  #canvas;
  #body;
  #picture;
  #zoom;
  #marks;
  #reading;
  #ticking;
  #head = makeHead({
    toggle: () => this.#toggle(),
    toggleFull: () => this.#toggleFull(),
    unzoom: () => this.#zoom.reset(),
  });
  #problem = el("div", { class: "wv-pane-problem" });
  #legend = makeLegend();
  #title = "";
  #about = "";
  #isFolded = false;
  #said = "";
  #failed = "";
  /** @type {Partial<PictureHeader>} */
  #last = {};
  /** @type {number[]} */
  #times = [];
  #size = "";
  /** @type {ReturnType<typeof makeReadout> | null} */
  #readout = null;

  /**
   * `changed()` is called when it takes more or less room. One `withScene` draws the scene, too.
   *
   * @param {string} id
   * @param {() => void} changed
   * @param {boolean} withScene
   */
  constructor(id, changed, withScene) {
    this.#id = id;
    this.#changed = changed;
    const canvas = el("canvas", {
      class: "wv-pane-picture",
      role: "img",
      tabindex: 0,
      ondblclick: () => (zoom.zoom() > 1 ? zoom.reset() : this.#toggleFull()),
    });
    this.#canvas = canvas;
    const zoom = makeZoom(canvas, () => this.#zoomed());
    this.#zoom = zoom;
    const picture = (withScene ? makeCamera : makePicture)(canvas, {
      drawn: () => this.#drawn(),
      fail: (sentence) => this.#fail(sentence),
    });
    this.#picture = picture;
    this.#reading = makeReading(id, canvas, {
      picture,
      header: () => this.#last,
      aboutAt: (mouse) => this.#marks.textAt(mouse),
    });
    const content = [canvas, this.#problem, this.#reading.element, this.#legend.element];
    this.#body = el("div", { class: "wv-pane-body" }, content);
    this.#marks = marksOver(canvas, this.#body, { picture, zoom });
    this.element = el(
      "section",
      { class: "wv-pane", tabindex: -1 },
      this.#head.element,
      this.#body,
    );
    takeKeysOf(canvas, (event) => takeKey(zoom, event));
    takeKeysOf(this.element, (event) => this.#press(event));
    this.#ticking = setInterval(() => this.#tellRate(), RATE_MS);
    frames.open(id, {
      width: () => this.#width(),
      take: (header, data) => this.#take(header, data),
    });
  }

  get head() {
    return this.#head.element;
  }

  isFolded() {
    return this.#isFolded;
  }

  title() {
    return this.#title;
  }

  /**
   * Shows it in the frame of a panel; returns what ends that.
   *
   * @param {HTMLElement} place
   * @param {HTMLElement} tools
   */
  openIn(place, tools) {
    if (this.#isFolded) this.#toggle();
    this.#setFull(false);
    place.append(this.element);
    tools.append(...this.#head.tools);
    const sizes = new ResizeObserver(frames.refresh);
    sizes.observe(this.element);
    return () => {
      sizes.disconnect();
      this.#head.restore();
      this.#changed();
    };
  }

  /** @param {PaneCaption} row */
  update(row) {
    const wanted = sanitized(row.title, 200);
    if (wanted !== this.#title)
      this.#isFolded = recall(`pane.${wanted}`, { isFolded: false }).isFolded ?? false;
    this.#title = wanted;
    this.#about = [sanitized(row.name, 100), wanted].join("\n");
    this.#said = sanitized(row.problem);
    this.#picture.hide?.(row.hidden ?? []);
    this.element.classList.toggle("wv-pane-empty", !row.has_picture);
    this.#write();
  }

  close() {
    clearInterval(this.#ticking);
    this.#marks.close();
    this.#reading.close();
    this.#picture.close();
    this.#readout?.close();
    frames.close(this.#id);
  }

  #isFull() {
    return this.element.classList.contains(FULL);
  }

  #toggle() {
    const key = `pane.${this.#title}`;
    this.#isFolded = !this.#isFolded;
    remember(key, { ...recall(key, {}), isFolded: this.#isFolded });
    if (this.#isFolded) this.#setFull(false);
    this.#write();
    this.#changed();
  }

  #toggleFull() {
    this.#setFull(!this.#isFull());
    if (this.#isFolded) this.#toggle();
    this.#changed();
  }

  /** @param {boolean} wanted */
  #setFull(wanted) {
    this.element.classList.toggle(FULL, wanted);
    if (wanted) this.element.focus(); // for Escape
    this.#write();
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    if (event.key !== "Escape" || !this.#isFull()) return false;
    this.#setFull(false);
    this.#changed();
    return true;
  }

  #zoomed() {
    this.#head.showZoom(this.#zoom.zoom());
    this.#marks.redraw();
    frames.refresh(); // a larger picture has more to show
  }

  #write() {
    const [title, isFolded] = [this.#title, this.#isFolded];
    this.element.classList.toggle("wv-pane-folded", isFolded);
    this.#head.update({ title, about: this.#about, isFolded, isFull: this.#isFull() });
    set(this.element, { "aria-label": `${this.#readout ? "Text" : "Image"} ${title}` });
    set(this.#canvas, { "aria-label": title });
    showText(this.#problem, this.#failed || this.#said);
  }

  #tellRate() {
    if (this.#readout) return this.#head.tell(this.#readout.facts());
    const now = performance.now();
    this.#times = this.#times.filter((time) => time > now - RATE_MS);
    const [width, height] = this.#picture.size();
    const isShown = width && !this.#isFolded;
    this.#head.tell(isShown ? `${width} × ${height} · ${this.#times.length} Hz` : "");
  }

  // The width in pixels of the screen at which the picture is shown.
  #width() {
    if (this.#isFolded) return 0;
    if (this.#readout) return this.#body.clientWidth;
    return this.#canvas.clientWidth && this.#zoom.zoom() * this.#picture.width();
  }

  #drawn() {
    this.#times.push(performance.now());
    if (this.#failed) this.#fail("");
    const size = this.#picture.size();
    if (size.join() === this.#size) return;
    this.#size = size.join();
    this.#body.style.setProperty("--wv-aspect", size.join(" / "));
    this.#tellRate();
    frames.refresh();
  }

  /** @param {string} sentence */
  #fail(sentence) {
    this.#failed = sentence;
    this.#write();
  }

  /**
   * @param {PictureHeader} header
   * @param {Uint8Array<ArrayBuffer>} data
   */
  async #take(header, data) {
    try {
      if (header.mime === TEXT) return this.#takeText(header, data);
      await this.#picture.take(header, data);
      this.#last = header;
      this.#marks.show(header.marks ?? []);
      this.element.dataset.stamp = String(header.stamp);
      this.#legend.show(header.legend);
      this.#reading.read();
    } catch (error) {
      this.#fail(error instanceof Error ? error.message : String(error));
    }
  }

  /**
   * @param {PictureHeader} header
   * @param {Uint8Array<ArrayBuffer>} data
   */
  #takeText(header, data) {
    if (!this.#readout) {
      this.#readout = makeReadout(this.#body, this.#id);
      this.element.classList.add("wv-pane-text");
      this.#write();
    }
    this.#readout.take(header, data);
    this.element.dataset.stamp = String(header.stamp);
    this.#tellRate();
  }
}
