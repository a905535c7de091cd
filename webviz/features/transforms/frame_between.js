// Two frames, and the transform between them.

import { copyAndTell } from "webviz/clipboard.js";
import { combobox } from "webviz/controls/combobox.js";
import { el } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { recall, remember } from "webviz/remember.js";
import { batch, computed, effect, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { spanText } from "webviz/panels/units.js";

/** @import {Stores} from "webviz/contents.js" */
/** @import {StoreReader} from "webviz/types.js" */

/** @typedef {StoreReader<Stores["between"]> | null} Values what is known of two frames that are chosen */

const ROWS = {
  Translation: "x, y, z",
  Quaternion: "x, y, z, w",
  "Roll, pitch, yaw": "About the fixed axes x, y, z",
  Distance: "Between the origins",
};

/**
 * A number with a real minus, and none before a zero.
 *
 * @param {number} value
 * @param {number} digits
 */
function number(value, digits) {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

/**
 * @param {number[]} values
 * @param {number} digits
 * @param {string} [unit]
 */
const numbers = (values, digits, unit = "") =>
  values.map((value) => number(value, digits) + unit).join("  ");

/**
 * Two frames to choose, and the transform between them.
 *
 * @param {() => string[]} names of all frames, read in effects
 */
export function between(names) {
  const first = { target: "", source: "", ...recall("tf-between", {}) };
  const chosen = { source: signal(first.source), target: signal(first.target) };
  const source = () => chosen.source.value;
  const target = () => chosen.target.value;
  const values = () =>
    target() && source() ? store(`between:${JSON.stringify([target(), source()])}`) : null;
  const isThere = () => values()?.has("translation") ?? false;
  effect(() => remember("tf-between", { target: target(), source: source() }));

  /**
   * @param {"source" | "target"} which
   * @param {string} label
   */
  const pick = (which, label) =>
    combobox({
      label,
      value: () => chosen[which].value,
      options: () => names().map((value) => ({ value })),
      placeholder: "Frame",
      change: (value) => (chosen[which].value = value),
    }).element;
  const swap = () =>
    batch(() => {
      const before = source();
      chosen.source.value = target();
      chosen.target.value = before;
    });
  const texts = computed(() => textsOf(values()));
  const copyAll = () => {
    const lines = Object.entries(texts.value).map(([name, text]) => `${name}: ${text}`);
    copyAndTell(`${source()} in ${target()}\n${lines.join("\n")}\n`);
  };
  const rows = Object.entries(ROWS).map(([name, title]) =>
    el(
      "div",
      { title },
      el("dt", { class: "wv-quiet" }, name),
      el("dd", { class: "wv-number" }, () => texts.value[name]),
    ),
  );
  const note = { class: "wv-between-note wv-quiet", role: "status" };
  return el(
    "section",
    { class: "wv-between", "aria-label": "Transform between two frames" },
    el(
      "div",
      { class: "wv-between-frames" },
      pick("source", "Frame"),
      el("span", { class: "wv-quiet" }, "in"),
      pick("target", "In frame"),
      iconButton("refresh", "Swap the frames", swap),
      iconButton("copy", "Copy transform", copyAll, { tip: "Copy", disabled: () => !isThere() }),
    ),
    el("dl", { class: "wv-between-values", "aria-live": "off", hidden: () => !isThere() }, rows),
    el("div", { ...note, "data-level": () => (values()?.get("problem") ? "warn" : null) }, () =>
      noteOf(values()),
    ),
  );
}

/**
 * @param {Values} values
 * @returns {Record<string, string>}
 */
const textsOf = (values) => ({
  Translation: `${numbers(values?.get("translation") ?? [], 3)} m`,
  Quaternion: numbers(values?.get("rotation") ?? [], 4),
  "Roll, pitch, yaw": numbers(values?.get("rpy") ?? [], 1, "°"),
  Distance: `${number(values?.get("distance") ?? 0, 3)} m`,
});

/** @param {Values} values */
function noteOf(values) {
  if (!values) return "Choose two frames to read out the transform.";
  const problem = values.get("problem");
  if (problem !== undefined) return problem;
  if (!values.has("translation")) return "";
  const age = values.get("age") ?? null;
  return age === null ? "Static." : `At the newest common time, ${spanText(Math.max(0, age))} ago.`;
}
