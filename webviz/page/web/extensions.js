// Modules that plug-ins bring. Each has a default export that is called with `page`, below: it adds
// gestures, widgets, overlays and tabs by the functions by which the page adds its own. Modules of
// the page are imported as "webviz/dom.js".

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { fitted } from "webviz/charts/canvas.js";
import { copy, copyAndTell } from "webviz/clipboard.js";
import { indent, keyOf, rowList, touchable } from "webviz/controls/rows.js";
import { searchField } from "webviz/controls/fields.js";
import { el, set, setChildren, setText, showText, svgElement } from "webviz/dom.js";
import { withErrorBoundary, textOf } from "webviz/error_boundary.js";
import { icon, iconButton, textButton } from "webviz/icons.js";
import { overlay } from "webviz/overlay/overlay.js";
import { foldByKey } from "webviz/panels/folds.js";
import { messageRows } from "webviz/panels/message_rows.js";
import { panel } from "webviz/panels/panels.js";
import { widget } from "webviz/panels/plugin_widgets.js";
import { listenToPanning } from "webviz/panning.js";
import { groundAt, onCanvas, planeAt, surfaceAt } from "webviz/scene/ground.js";
import { root } from "webviz/signals.js";
import { csvText } from "webviz/csv.js";
import { download } from "webviz/download.js";
import { timeOfDay } from "webviz/time_text.js";
import { toast } from "webviz/toasts.js";
import { watch } from "webviz/stores.js";
import { gesture } from "webviz/tools/gestures.js";
import { showLiveHint } from "webviz/tools/hint.js";
import { makeLayer } from "webviz/tools/layer.js";
import { beforeRender, camera, canvas, requestRender } from "webviz/viser_page.js";

/** @import {Panel} from "webviz/types.js" */
/** @import {MakeWidget} from "webviz/panels/plugin_widgets.js" */

/**
 * Makes a widget of a plug-in, whose values are its own.
 *
 * @typedef {(values: any, send: (value: unknown) => unknown) => {
 *   element: HTMLElement, head?: HTMLElement, update(values: any, part: (key: string) => any): void, close?(): void,
 * }} MakeOwn
 */

/** The argument of the default export of a module. @typedef {typeof page} Page */

const page = Object.freeze({
  act,
  beforeRender,
  canvas,
  el,
  gesture,
  groundAt,
  makeLayer,
  needs,
  onCanvas,
  overlay,
  panel: (/** @type {Panel} */ added) => panel(ownPanel(added)),
  set,
  toast,
  watch,
  widget: (/** @type {string} */ kind, /** @type {MakeOwn} */ make) =>
    widget(`own ${kind}`, ownWidget(make)),
});

/** Members of before, for one version: a module imports them, as from "webviz/dom.js". */
const former = {
  camera,
  copy,
  copyAndTell,
  csvText,
  download,
  fitted,
  foldByKey,
  icon,
  iconButton,
  indent,
  keyOf,
  listenToPanning,
  messageRows,
  planeAt,
  requestRender,
  rowList,
  searchField,
  setChildren,
  setText,
  showText,
  style,
  surfaceAt,
  svgElement,
  tellLive: showLiveHint,
  textButton,
  timeOfDay,
  touchable,
};

/** Functions of the page that call those of a module; such is the last argument of the first. */
const LISTENING = /** @type {const} */ (["beforeRender", "gesture", "watch", "widget"]);
const CALLING = /** @type {const} */ ([...LISTENING, "listenToPanning", "panel", "toast"]);
const all = { ...former, ...page };

/**
 * The page for a module, of which no function that throws stops the page.
 *
 * @param {(error: unknown) => void} report
 * @returns {Page}
 */
function pageFor(report) {
  /** @param {typeof CALLING[number]} name */
  const wrap =
    (name) =>
    (/** @type {unknown[]} */ ...args) => {
      const isFunction = typeof args.at(-1) === "function";
      if (!isFunction && LISTENING.some((each) => each === name))
        throw new TypeError(`${name} expects a function`);
      return Reflect.apply(
        all[name],
        all,
        args.map((each) => withErrorBoundary(each, report)),
      );
    };
  const wrappers = Object.fromEntries(CALLING.map((name) => [name, wrap(name)]));
  return Object.freeze({ ...all, ...wrappers });
}

/**
 * A panel of a module, complete; what its `open` returns counts only if it can be called.
 *
 * @param {Panel} panel
 * @returns {Panel}
 */
function ownPanel({ name, title, isOnDemand = false, open }) {
  if (!name || !title || !open) throw new TypeError("a panel needs a name, a title and open()");
  return {
    name: String(name),
    title: String(title),
    isOnDemand,
    open(element, head) {
      const end = open(element, head);
      return typeof end === "function" ? end : undefined;
    },
  };
}

/**
 * The values of a widget are one value of JSON in either direction; its effects end with it.
 *
 * @param {MakeOwn} make
 * @returns {MakeWidget}
 */
const ownWidget = (make) => (values, send) =>
  root((end) => {
    const instance = make(values.values, (value) => send(JSON.stringify(value)));
    if (!(instance?.element instanceof Element && instance.update)) return failed();
    return {
      ...instance,
      update: (now, store, id) => instance.update(now.values, (key) => store.get(`${id}/${key}`)),
      close() {
        end();
        instance.close?.();
      },
    };
  });

const failed = () => ({
  element: el("div", { class: "wv-quiet" }, "This widget failed."),
  update() {},
});

/** @type {Map<string, CSSStyleSheet>} */
const sheets = new Map();

/**
 * Adds style rules, or replaces those that were added under the same name.
 *
 * @param {string} name
 * @param {string} rules
 */
function style(name, rules) {
  const sheet = sheets.get(name) ?? new CSSStyleSheet();
  sheet.replaceSync(rules);
  if (!sheets.has(name)) document.adoptedStyleSheets.push(sheet);
  sheets.set(name, sheet);
}

const MAX_REPORTS = 3; // of a module: a fault may occur in every frame
const IMPORT = /^(import\b[^"';(]*)["']\.\/([^"'/]+)["']/gm; // as in webviz/api/modules.py

/**
 * Starts the module of a plug-in. A fault of it is shown, and stops nothing else.
 *
 * @param {string} name of the plug-in
 * @param {[string, string][]} files names and texts of its module, the last, and of what it needs
 */
export async function start(name, files) {
  const folder = new URL(`webviz/plugin/${encodeURIComponent(name)}/`, location.href);
  /** @type {Map<string, string>} */
  const addresses = new Map();
  const reported = new Set();
  const report = (/** @type {unknown} */ error) => {
    const text = textOf(error);
    if (reported.has(text) || reported.size === MAX_REPORTS) return;
    reported.add(text);
    console.info(error);
    toast(`The module of the ${name} failed: ${text}`, { level: "error" });
  };
  for (const [file, source] of files) {
    if (file.endsWith(".css")) {
      style(`${name}/${file}`, source);
      continue;
    }
    const text = source.replace(IMPORT, (_, words, other) => `${words}"${addresses.get(other)}"`);
    const parts = [text, `\n//# sourceURL=${new URL(file, folder)}`];
    addresses.set(file, URL.createObjectURL(new Blob(parts, { type: "text/javascript" })));
  }
  try {
    const { default: begin } = await import([...addresses.values()].at(-1) ?? "");
    await begin(pageFor(report));
  } catch (error) {
    report(error);
  } finally {
    for (const address of addresses.values()) URL.revokeObjectURL(address);
  }
}
