// A pane: the picture of one display, its title, and the value under the mouse.

import { el } from "webviz/dom.js";
import { takeKeysOf } from "webviz/keys.js";
import { sanitized } from "webviz/sanitize.js";
import { recall, remember } from "webviz/remember.js";
import { batch, signal, untracked } from "webviz/signals.js";
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
/** @import {Signal} from "webviz/signals.js" */

const RATE_MS = 1000;
const TEXT = "application/json";

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
  #head;
  #end;
  #title = signal("");
  #about = signal("");
  #facts = signal("");
  #factor = signal(1);
  #isFolded = signal(false);
  #isFull = signal(false);
  #isEmpty = signal(false);
  #problem = signal("");
  #failed = signal("");
  /** @type {Signal<Partial<PictureHeader>>} */
  #last = signal({});
  /** @type {number[]} */
  #times = [];
  #size = "";
  /** @type {Signal<ReturnType<typeof makeReadout> | null>} */
  #readout = signal(null);

  /**
   * `changed()` is called when it takes more or less room, and `end()` as it is closed. One `withScene`
   * draws the scene, too.
   *
   * @param {string} id
   * @param {boolean} withScene
   * @param {{changed: () => void, end: () => void}} dock
   */
  constructor(id, withScene, { changed, end }) {
    this.#id = id;
    this.#changed = changed;
    this.#end = end;
    const canvas = el("canvas", {
      class: "wv-pane-picture",
      role: "img",
      "aria-label": this.#title,
      tabindex: 0,
      ondblclick: () => (zoom.zoom() > 1 ? zoom.reset() : this.#toggleFull()),
    });
    this.#canvas = canvas;
    const zoom = makeZoom(canvas, () => this.#zoomed());
    this.#zoom = zoom;
    const picture = (withScene ? makeCamera : makePicture)(canvas, {
      onDraw: () => this.#afterDraw(),
      fail: (sentence) => (this.#failed.value = sentence),
    });
    this.#picture = picture;
    this.#reading = makeReading(id, canvas, {
      picture,
      header: () => this.#last.value,
      aboutAt: (mouse) => this.#marks.textAt(mouse),
    });
    const problem = () => this.#failed.value || this.#problem.value;
    this.#body = el(
      "div",
      { class: "wv-pane-body" },
      canvas,
      el("div", { class: "wv-pane-problem", hidden: () => !problem() }, problem),
      this.#reading.element,
      makeLegend(() => this.#last.value.legend),
    );
    this.#marks = marksOver(canvas, this.#body, { picture, zoom });
    this.#head = this.#makeHead();
    this.element = el(
      "section",
      {
        class: () => this.#classes(),
        tabindex: -1,
        "aria-label": () => `${this.#readout.value ? "Text" : "Image"} ${this.#title.value}`,
      },
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

  #makeHead() {
    return makeHead({
      title: () => this.#title.value,
      about: () => this.#about.value,
      facts: () => this.#facts.value,
      zoom: () => this.#factor.value,
      isFolded: () => this.#isFolded.value,
      isFull: () => this.#isFull.value,
      toggle: () => this.#toggle(),
      toggleFull: () => this.#toggleFull(),
      unzoom: () => this.#zoom.reset(),
    });
  }

  #classes() {
    return [
      "wv-pane",
      this.#isFolded.value && "wv-pane-folded",
      this.#isFull.value && "wv-pane-full",
      this.#isEmpty.value && "wv-pane-empty",
      this.#readout.value && "wv-pane-text",
    ]
      .filter(Boolean)
      .join(" ");
  }

  get head() {
    return this.#head.element;
  }

  isFolded() {
    return untracked(() => this.#isFolded.value);
  }

  title() {
    return this.#title.value;
  }

  /**
   * Shows it in the frame of a panel; returns what ends that.
   *
   * @param {HTMLElement} place
   * @param {HTMLElement} tools
   */
  openIn(place, tools) {
    if (this.isFolded()) this.#toggle();
    this.#isFull.value = false;
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
    const title = sanitized(row.title, 200);
    batch(() => {
      if (title !== this.#title.value)
        this.#isFolded.value = recall(`pane.${title}`, { isFolded: false }).isFolded ?? false;
      this.#title.value = title;
      this.#about.value = [sanitized(row.name, 100), title].join("\n");
      this.#problem.value = sanitized(row.problem);
      this.#isEmpty.value = !row.has_picture;
    });
    this.#picture.hide?.(row.hidden ?? []);
  }

  close() {
    clearInterval(this.#ticking);
    this.#marks.close();
    this.#reading.close();
    this.#picture.close();
    this.#readout.value?.close();
    frames.close(this.#id);
    this.#end();
  }

  #toggle() {
    const key = `pane.${this.title()}`;
    const isFolded = !this.isFolded();
    batch(() => {
      this.#isFolded.value = isFolded;
      if (isFolded) this.#isFull.value = false;
    });
    remember(key, { ...recall(key, {}), isFolded });
    this.#changed();
  }

  #toggleFull() {
    this.#isFull.value = !this.#isFull.value;
    if (this.#isFull.value) this.element.focus(); // for Escape
    if (this.isFolded()) this.#toggle();
    this.#changed();
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    if (event.key !== "Escape" || !this.#isFull.value) return false;
    this.#isFull.value = false;
    this.#changed();
    return true;
  }

  #zoomed() {
    this.#factor.value = this.#zoom.zoom();
    this.#marks.redraw();
    frames.refresh(); // a larger picture has more to show
  }

  #tellRate() {
    this.#facts.value = this.#factsNow();
  }

  #factsNow() {
    if (this.#readout.value) return this.#readout.value.facts();
    const now = performance.now();
    this.#times = this.#times.filter((time) => time > now - RATE_MS);
    const [width, height] = this.#picture.size();
    if (!width || this.isFolded()) return "";
    return `${width} × ${height} · ${this.#times.length} Hz`;
  }

  // The width in pixels of the screen at which the picture is shown.
  #width() {
    if (this.isFolded()) return 0;
    if (this.#readout.value) return this.#body.clientWidth;
    return this.#canvas.clientWidth && this.#zoom.zoom() * this.#picture.width();
  }

  #afterDraw() {
    this.#times.push(performance.now());
    this.#failed.value = "";
    const size = this.#picture.size();
    if (size.join() === this.#size) return;
    this.#size = size.join();
    this.#body.style.setProperty("--wv-aspect", size.join(" / "));
    this.#tellRate();
    frames.refresh();
  }

  /**
   * @param {PictureHeader} header
   * @param {Uint8Array<ArrayBuffer>} data
   */
  async #take(header, data) {
    try {
      if (header.mime === TEXT) return this.#takeText(header, data);
      await this.#picture.take(header, data);
      this.#last.value = header;
      this.#marks.show(header.marks ?? []);
      this.element.dataset.stamp = String(header.stamp);
      this.#reading.read();
    } catch (error) {
      this.#failed.value = error instanceof Error ? error.message : String(error);
    }
  }

  /**
   * @param {PictureHeader} header
   * @param {Uint8Array<ArrayBuffer>} data
   */
  #takeText(header, data) {
    this.#readout.value ??= makeReadout(this.#body, this.#id);
    this.#readout.value.take(header, data);
    this.element.dataset.stamp = String(header.stamp);
    this.#tellRate();
  }
}
