// Drawings over the scene, below the controls of the page.

import { el } from "webviz/dom.js";
import { canvas } from "webviz/viser_page.js";

/** @import {Child} from "webviz/types.js" */

/**
 * A layer over the canvas; `place()` moves it to where the canvas is.
 *
 * @param {string} name
 * @param {...Child} children
 */
export function makeLayer(name, ...children) {
  const element = el("div", { class: "wv-layer", "data-webviz": name }, ...children);
  let style = "";
  document.body.append(element);
  return {
    element,
    place() {
      const { left, top, width, height } = canvas().getBoundingClientRect();
      const box = `left: ${left}px; top: ${top}px; width: ${width}px; height: ${height}px`;
      if (box !== style) element.style.cssText = style = box;
    },
  };
}
