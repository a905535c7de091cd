// The tree of frames as rows.

import { el } from "webviz/dom.js";
import { effect } from "webviz/signals.js";
import { wordsOf } from "webviz/words.js";
import { foldMark, showFold } from "webviz/panels/folds.js";
import { rateText, spanText } from "webviz/panels/units.js";

/** @import {Frame} from "webviz/contents.js" */
/** @import {ValuesOf} from "webviz/types.js" */

/**
 * @typedef {ValuesOf<"transforms">} Frames
 * @typedef {{
 *   key: string, depth: number, name: string, isOpen: boolean | null, frame: Frame | null,
 *   isLoop: boolean,
 * }} FrameRow
 */

/**
 * The rows that are not folded away: `{key, depth, name, isOpen, frame, children}`; `isOpen` is null
 * without children. Of a search, frames with every word of the text, and those on the way to them.
 *
 * @param {Frames} values
 * @param {Set<string>} folded
 * @param {string} text
 */
export function frameRows(values, folded, text) {
  /** @type {Map<string, string[]>} */
  const children = new Map();
  for (const [name, { parent }] of frames(values)) {
    children.set(parent, [...(children.get(parent) ?? []), name]);
  }
  const words = wordsOf(text);
  /** @type {FrameRow[]} */
  const rows = [];

  /**
   * @param {string} name
   * @param {number} depth
   * @param {Set<string>} path
   * @returns {boolean}
   */
  function add(name, depth, path) {
    const frame = values.get(name) ?? null;
    const isLoop = path.has(name);
    const own = isLoop ? [] : (children.get(name) ?? []);
    const all = `${name} ${frame?.nodes.join(" ") ?? ""}`.toLowerCase();
    const isFound = words.every((word) => all.includes(word));
    const isOpen = own.length ? words.length > 0 || !folded.has(name) : null;
    const at = rows.length;
    rows.push({ key: `${[...path].join("\n")}\n${name}`, depth, name, isOpen, frame, isLoop });
    const inside = new Set(path).add(name);
    const matches = isOpen ? own.filter((child) => add(child, depth + 1, inside)) : [];
    if (isFound || matches.length || !words.length) return true;
    rows.splice(at);
    return false;
  }

  for (const root of values.get("/roots") ?? []) add(root, 0, new Set());
  return rows;
}

/**
 * Names and values of all child frames.
 *
 * @param {Frames} values
 */
export const frames = (values) =>
  [...values].filter(([name]) => name !== "/roots" && name !== "/problems");

/**
 * Names of all frames, sorted.
 *
 * @param {Frames} values
 */
export function frameNames(values) {
  const names = frames(values).flatMap(([name, { parent }]) => [name, parent]);
  return [...new Set([...names, ...(values.get("/roots") ?? [])])].filter(Boolean).sort();
}

/** @param {() => FrameRow} row read in effects */
export function frameRow(row) {
  const frame = () => row().frame;
  const problems = () => frame()?.problems ?? [];
  const age = () => {
    const current = frame();
    return current && !current.is_static ? ageText(current) : "";
  };
  const element = el(
    "div",
    { class: "wv-frame", "data-tip": () => [row().name, ...problems()].join("\n") },
    foldMark(),
    el("span", { class: "wv-frame-name wv-ellipsis" }, () =>
      row().isLoop ? `${row().name} (loop)` : row().name,
    ),
    el("span", { class: "wv-frame-node wv-ellipsis wv-quiet" }, () =>
      (frame()?.nodes ?? []).join(", "),
    ),
    el("span", { class: "wv-frame-fact wv-quiet wv-number" }, () => factOf(frame())),
    el("span", { class: "wv-frame-age wv-quiet wv-number" }, age),
    el("span", {
      class: "wv-dot",
      "data-level": () => (problems().length ? "warn" : null),
      "data-tip": () => problems().join("\n") || null,
    }),
  );
  effect(() => showFold(element, row()));
  return element;
}

/**
 * The rate of a frame, as text.
 *
 * @param {Frame | null} frame
 */
export function factOf(frame) {
  if (!frame) return "";
  if (frame.is_static) return "static";
  if (!frame.samples) return "no data";
  return frame.hz ? rateText(frame.hz) : "one sample";
}

/**
 * The age of the newest transform of a frame; times of a simulation are no ages for wall time.
 *
 * @param {Frame} frame
 */
export function ageText({ age }) {
  if (age === null) return "";
  return age < -0.5 ? `${spanText(-age)} ahead` : spanText(Math.max(0, age));
}
