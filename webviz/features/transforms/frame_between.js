// Two frames, and the transform between them.

import { copyAndTell } from "../../clipboard.js";
import { combobox } from "../../controls/combobox.js";
import { el, set, setText } from "../../dom.js";
import { iconButton } from "../../icons.js";
import { recall, remember } from "../../remember.js";
import { watch } from "../../stores.js";
import { spanText } from "../../panels/units.js";

/** @import {ValuesOf} from "../../types.js" */

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

/** Returns `{element, offer(names), choose(source), close}`. */
export function between() {
  /** @type {() => void} */
  let end = () => {};
  const chosen = { target: "", source: "", ...recall("tf-between", {}) };
  /** @type {string[]} */
  let offered = [];

  /**
   * @param {"source" | "target"} which
   * @param {string} label
   */
  const pick = (which, label) =>
    combobox({
      label,
      value: chosen[which],
      options: [],
      placeholder: "Frame",
      change: (value) => change(which, value),
    });
  const boxes = { source: pick("source", "Frame"), target: pick("target", "In frame") };
  const swap = iconButton("refresh", "Swap the frames", () => {
    [chosen.target, chosen.source] = [chosen.source, chosen.target];
    follow();
  });
  const copyButton = iconButton("copy", "Copy transform", copyAll, { tip: "Copy" });
  const rows = Object.entries(ROWS).map(([name, title]) => {
    const value = el("dd", { class: "wv-number" });
    return {
      name,
      value,
      element: el("div", { title }, el("dt", { class: "wv-quiet" }, name), value),
    };
  });
  const list = el(
    "dl",
    { class: "wv-between-values", "aria-live": "off" },
    rows.map((row) => row.element),
  );
  const note = el("div", { class: "wv-between-note wv-quiet", role: "status" });
  const element = el(
    "section",
    { class: "wv-between", "aria-label": "Transform between two frames" },
    el(
      "div",
      { class: "wv-between-frames" },
      boxes.source.element,
      el("span", { class: "wv-quiet" }, "in"),
      boxes.target.element,
      swap,
      copyButton,
    ),
    list,
    note,
  );

  /**
   * @param {"source" | "target"} which
   * @param {string} value
   */
  function change(which, value) {
    chosen[which] = value;
    follow();
  }

  function follow() {
    remember("tf-between", chosen);
    offer(offered);
    end();
    end = () => {};
    show(null);
    if (chosen.target && chosen.source) {
      end = watch(`between:${JSON.stringify([chosen.target, chosen.source])}`, (values) =>
        show(values),
      );
    }
  }

  /** @param {ValuesOf<"between"> | null} values */
  function show(values) {
    const isThere = values?.has("translation") ?? false;
    if (values && isThere) {
      const texts = [
        `${numbers(values.get("translation") ?? [], 3)} m`,
        numbers(values.get("rotation") ?? [], 4),
        numbers(values.get("rpy") ?? [], 1, "°"),
        `${number(values.get("distance") ?? 0, 3)} m`,
      ];
      rows.forEach(({ value }, index) => setText(value, texts[index]));
    }
    set(list, { hidden: !isThere });
    set(copyButton, { disabled: !isThere });
    setText(note, noteOf(values));
    set(note, { "data-level": values?.get("problem") ? "warn" : null });
  }

  /** @param {ValuesOf<"between"> | null} values */
  function noteOf(values) {
    if (!chosen.target || !chosen.source) return "Choose two frames to read out the transform.";
    const problem = values?.get("problem");
    if (problem !== undefined) return problem;
    if (!values?.has("translation")) return "";
    const age = values.get("age") ?? null;
    return age === null
      ? "Static."
      : `At the newest common time, ${spanText(Math.max(0, age))} ago.`;
  }

  function copyAll() {
    const text = rows.map(({ name, value }) => `${name}: ${value.textContent}`).join("\n");
    copyAndTell(`${chosen.source} in ${chosen.target}\n${text}\n`);
  }

  /** @param {string[]} names */
  function offer(names) {
    offered = names;
    const options = names.map((value) => ({ value }));
    for (const which of /** @type {const} */ (["source", "target"]))
      boxes[which].update({ value: chosen[which], options });
  }

  follow();
  return {
    element,
    /** @param {string[]} names */
    offer(names) {
      if (names.join("\n") !== offered.join("\n")) offer(names);
    },
    close: () => end(),
  };
}
