// A static frame that is tried in another pose: a banner on every page, with the lines to copy.

import { needs, why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { copyAndTell } from "webviz/clipboard.js";
import { number } from "webviz/controls/number.js";
import { el } from "webviz/dom.js";
import { textButton } from "webviz/icons.js";
import { overlay } from "webviz/overlay/overlay.js";
import { findingsSection } from "webviz/panels/findings_sections.js";
import { frameAction } from "webviz/panels/frame_actions.js";
import { command } from "webviz/commands.js";
import { effect, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import * as registry from "webviz/tools/registry.js";

/** The numbers of a pose, as `MoveFrame` takes them, with their units. */
const NUMBERS = /** @type {const} */ ([
  ["x", "m"],
  ["y", "m"],
  ["z", "m"],
  ["roll", "rad"],
  ["pitch", "rad"],
  ["yaw", "rad"],
]);
const BESIDE =
  "No laser scan of this frame is compared with a map: add displays of both to see how it fits.";

/** @param {string} frame */
function tryFrame(frame) {
  registry.select(null); // Interact, which drags handles
  act("TryFrame", { frame });
}

const end = () => act("EndTrial", {});

export function install() {
  frameAction({
    label: "What if…",
    tip: "Try this frame in another pose; nothing is published",
    needs: "TryFrame",
    isFor: (frame) => frame?.is_static ?? false,
    run: tryFrame,
  });
  overlay("cards", "what if", banner());
  findingsSection(() => ({ trial }));
}

/** Says in the doctor that it examines what is tried. */
function trial() {
  const frame = store("what_if").get("frame");
  return frame === undefined
    ? ""
    : `Trial pose active: "What if" has moved ${frame}. The findings include it.`;
}

/** The banner; hidden while no frame is tried. */
function banner() {
  const values = store("what_if");
  const isTried = () => values.get("frame") !== undefined;
  const title = () => {
    const who = values.get("browser") === window.webviz.browser ? "you" : "another browser";
    return `What if: ${who} moved ${values.get("frame") ?? ""} on all pages. Nothing is published.`;
  };
  const fits = () => (values.get("fits") ?? []).join(". ") || BESIDE;
  const find = textButton("Find it", () => act("FindFrame", {}), {
    tip: "Move it to where its scan fits the map best: x, y and yaw",
  });
  const doneButton = textButton("Done", end, { tip: "Return it to its published pose (Esc)" });
  const element = el(
    "section",
    { class: "wv-card wv-what-if", hidden: () => !isTried(), "aria-label": "What if" },
    el(
      "div",
      { class: "wv-what-if-head" },
      el("b", {}, title),
      needs("FindFrame", find),
      needs("EndTrial", doneButton),
    ),
    el("p", { role: "status", "aria-live": "polite" }, fits),
    numbers(),
    line("Copy the URDF origin", () => values.get("urdf") ?? ""),
    line("Copy the command", () => values.get("command") ?? ""),
  );
  effect(() => void document.body.classList.toggle("wv-trying", isTried()));
  command({
    name: "End the what-if",
    key: "Escape",
    group: "Tools",
    needs: "EndTrial",
    isThere: () => isTried() && registry.isDefault() && !why("EndTrial"),
    run: end,
  });
  return element;
}

/** The pose of the frame in its parent, to be typed, stepped or dragged; degrees as "30°". */
function numbers() {
  const problem = signal("");
  const now = () => store("what_if").get("pose");
  const fields = NUMBERS.map(([name, unit], index) => {
    const control = number(
      { kind: "float", unit },
      {
        label: name,
        value: () => now()?.[index],
        change(/** @type {number} */ value) {
          const pose = /** @type {number[]} */ (now()).with(index, value);
          const [x, y, z, roll, pitch, yaw] = pose;
          return act("MoveFrame", { x, y, z, roll, pitch, yaw });
        },
        refused: (text) => (problem.value = text),
      },
    );
    return el("label", {}, el("span", {}, name), needs("MoveFrame", control.element));
  });
  return el(
    "div",
    {},
    el("div", { class: "wv-what-if-numbers" }, fields),
    el("p", { class: "wv-problem", role: "alert", hidden: () => !problem.value }, problem),
  );
}

/**
 * A line of text with a button that copies it.
 *
 * @param {string} label
 * @param {() => string} text
 */
const line = (label, text) =>
  el(
    "div",
    { class: "wv-what-if-line" },
    el("code", { class: "wv-ellipsis", "data-tip": text }, text),
    textButton("Copy", () => copyAndTell(text()), { "aria-label": label }),
  );
