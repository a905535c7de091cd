// Lists and dictionaries: an entry per line, texts as they are, all else as JSON.

import { el } from "webviz/dom.js";
import { entry } from "webviz/controls/entry.js";

/** @import {Control, ControlOptions} from "webviz/types.js" */

/** @typedef {unknown[] | Record<string, unknown>} Lines */
/** @import {DeclaredProperty} from "webviz/contents.js" */

const MAX_ROWS = 12;

/**
 * A field of several lines; see `control.js`.
 *
 * @param {DeclaredProperty} property
 * @param {ControlOptions<Lines>} options
 * @returns {Control}
 */
export function lines(property, options) {
  const area = el("textarea", {
    class: "wv-field wv-lines",
    "aria-label": options.label,
    rows: 1,
    placeholder: property.kind === "dict" ? "name: value" : "one entry per line",
  });
  const fit = () => {
    const rows = Math.min(MAX_ROWS, area.value.split("\n").length);
    if (area.rows !== rows) area.rows = rows;
  };
  return entry(area, {
    ...options,
    encode: (value) => encode(property, value),
    decode: (text) => decode(property, text),
    after: fit,
  });
}

/**
 * The text for a list or a dictionary.
 *
 * @param {Pick<DeclaredProperty, "items">} property
 * @param {Lines} value
 */
export function encode({ items }, value) {
  const dump = items === "text" ? flat : JSON.stringify;
  if (Array.isArray(value)) return value.map((item) => dump(item)).join("\n");
  return Object.entries(value)
    .map(([key, item]) => `${flat(key)}: ${dump(item)}`)
    .join("\n");
}

/**
 * The inverse; throws a sentence.
 *
 * @param {Pick<DeclaredProperty, "kind" | "items">} property
 * @param {string} text
 */
export function decode({ kind, items }, text) {
  const load = items === "text" ? (/** @type {string} */ item) => item : parse;
  const all = text
    .split(/\r?\n/)
    .map((line) => line.trim())
    .filter(Boolean);
  if (kind !== "dict") return all.map(load);
  const entries = all.map((line) => {
    // Names may have colons themselves.
    const end = line.search(/:(\s|$)/);
    if (end < 1) throw new Error(`Not changed: “${short(line)}” is not valid; enter name: value.`);
    return [line.slice(0, end), load(line.slice(end + 1).trim())];
  });
  return Object.fromEntries(entries);
}

/** @param {string} text */
function parse(text) {
  try {
    return JSON.parse(text);
  } catch {
    const message = `“${short(text)}” is not valid; enter true, 0.5 or "text".`;
    throw new Error(`Not changed: ${message}`);
  }
}

/** @param {string} text */
const flat = (text) => text.replace(/[\r\n]+/g, " ");
/** @param {string} text */
const short = (text) => (text.length > 60 ? `${text.slice(0, 59)}…` : text);
