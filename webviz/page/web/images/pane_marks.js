// The canvas of marks over the picture of a pane.

import { fitted } from "webviz/charts/canvas.js";
import { el } from "webviz/dom.js";
import { drawMarks, markAt, zoomedPlaces } from "webviz/images/marks.js";

/** @import {Mark} from "webviz/messages.js" */
/** @import {Picture} from "webviz/images/picture.js" */
/** @import {makeZoom} from "webviz/images/zoom.js" */

/**
 * Returns `{show(marks), redraw(), textAt(mouse), close()}`; the canvas is there while there are marks.
 *
 * @param {HTMLCanvasElement} canvas of the picture
 * @param {HTMLElement} body that it fills
 * @param {{picture: Picture, zoom: ReturnType<typeof makeZoom>}} shown
 */
export function marksOver(canvas, body, { picture, zoom }) {
  const overlay = el("canvas", { class: "wv-pane-marks" });
  /** @type {Mark[]} */
  let marks = [];

  function places() {
    const { clientWidth: width, clientHeight: height } = body;
    return zoomedPlaces(picture.placeIn(width, height), zoom.zoom(), zoom.corner(), height);
  }

  function redraw() {
    if (!marks.length) return overlay.remove();
    if (!overlay.isConnected) canvas.after(overlay);
    if (!body.clientWidth || !picture.size()[0]) return;
    drawMarks(fitted(overlay).context, marks, places());
  }
  const resized = new ResizeObserver(redraw);
  resized.observe(body);

  return {
    /** @param {Mark[]} next */
    show(next) {
      marks = next;
      redraw();
    },
    redraw,
    /** @param {{clientX: number, clientY: number}} mouse */
    textAt({ clientX, clientY }) {
      if (!marks.length) return "";
      const { left, top } = body.getBoundingClientRect();
      return markAt(marks, places(), [clientX - left, clientY - top]);
    },
    close: () => resized.disconnect(),
  };
}
