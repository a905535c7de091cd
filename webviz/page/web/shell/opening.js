// Openers: features add sections to the dialog "Open", and take files by their endings.

import { el } from "webviz/dom.js";

/** @import {Children} from "webviz/types.js" */
/** @import {Close} from "webviz/controls/dialog.js" */

/** @type {((close: Close) => Children[])[]} */
const added = [];
/** @type {Map<string, (file: File) => unknown>} */
const loaders = new Map();

/**
 * Adds a section to the dialog "Open": `make(close)` returns its elements; `close({run})` closes it and
 * runs what was chosen.
 *
 * @param {(close: Close) => Children[]} make
 */
export const filesSection = (make) => added.push(make);

/**
 * The elements of all sections.
 *
 * @param {Close} close
 */
export const sections = (close) => added.map((make) => el("section", {}, ...make(close)));

/**
 * Has files with an ending opened by `load(file)`, which are dropped on the page or uploaded.
 *
 * @param {string[]} endings such as ".mcap", or "" for files that nothing else takes
 * @param {(file: File) => unknown} load
 */
export function fileLoader(endings, load) {
  for (const ending of endings) loaders.set(ending, load);
}

/** The endings of files that can be opened. */
export const endings = () => [...loaders.keys()].filter(Boolean);

/**
 * Opens a file of this computer.
 *
 * @param {File} file
 */
export function load(file) {
  const ending = file.name.slice(file.name.lastIndexOf(".")).toLowerCase();
  return (loaders.get(ending) ?? loaders.get(""))?.(file);
}
