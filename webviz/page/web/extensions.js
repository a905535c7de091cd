// Modules that plug-ins bring. Each has a default export that is called with `page`, below: it adds
// gestures, widgets, overlays and tabs by the functions by which the page adds its own.

import { act } from "./act.js";
import { el, set, setChildren, setText, svgElement } from "./dom.js";
import { overlay } from "./overlay/overlay.js";
import { panel } from "./panels/panels.js";
import { widget } from "./panels/plugin_widgets.js";
import { groundAt, onCanvas, planeAt, surfaceAt } from "./scene/ground.js";
import { toast } from "./shell/toasts.js";
import { watch } from "./stores.js";
import { gesture } from "./tools/gestures.js";
import { tellLive } from "./tools/hint.js";
import { makeLayer } from "./tools/layer.js";
import { beforeRender, camera, canvas, requestRender } from "./viser_page.js";

/** @import {MakeWidget} from "./panels/plugin_widgets.js" */

/**
 * Makes a widget of a plug-in, whose values are its own.
 *
 * @typedef {(values: unknown, send: (value: unknown) => void) => {
 *   element: HTMLElement, update(values: unknown): void, close?(): void,
 * }} MakeOwn
 */

const page = Object.freeze({
  act,
  beforeRender,
  camera,
  canvas,
  el,
  gesture,
  groundAt,
  makeLayer,
  onCanvas,
  overlay,
  panel,
  planeAt,
  requestRender,
  set,
  setChildren,
  setText,
  surfaceAt,
  svgElement,
  tellLive,
  toast,
  watch,
  widget: (/** @type {string} */ kind, /** @type {MakeOwn} */ make) =>
    widget(`own ${kind}`, ownWidget(make)),
});

/**
 * The values of a widget are one value of JSON in either direction.
 *
 * @param {MakeOwn} make
 * @returns {MakeWidget}
 */
const ownWidget = (make) => (values, send) => {
  const made = make(values.values, (value) => send(JSON.stringify(value)));
  return { ...made, update: (now) => made.update(now.values) };
};

export function install() {
  watch("modules", (modules, changed) => {
    for (const name of changed) {
      const text = modules.get(name);
      if (text !== undefined) add(name, text);
    }
  });
}

/**
 * @param {string} name of the plug-in
 * @param {string} text of its module
 */
async function add(name, text) {
  const parts = [
    text,
    `\n//# sourceURL=${new URL(`webviz/plugin/${encodeURIComponent(name)}`, location.href)}`,
  ];
  const address = URL.createObjectURL(new Blob(parts, { type: "text/javascript" }));
  try {
    const { default: start } = await import(address);
    await start(page);
  } catch (error) {
    console.info(error);
    toast(`The module of the ${name} failed: ${error}`, { level: "error" });
  } finally {
    URL.revokeObjectURL(address);
  }
}
