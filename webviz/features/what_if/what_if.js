// A static frame that is tried in another pose: a banner on every page, with the lines to copy.

import { needs, why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { copyAndTell } from "webviz/clipboard.js";
import { number } from "webviz/controls/number.js";
import { el, set, setText, showText } from "webviz/dom.js";
import { textButton } from "webviz/icons.js";
import { overlay } from "webviz/overlay/overlay.js";
import { findingsSection } from "webviz/panels/findings_sections.js";
import { frameAction } from "webviz/panels/frame_actions.js";
import { command } from "webviz/commands.js";
import { store, watch } from "webviz/stores.js";
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
    : `A trial is on: ${frame} is moved in "What if". These are the findings with it.`;
}

/** The banner; hidden while no frame is tried. */
function banner() {
  let isTried = false;
  const title = el("b");
  const fits = el("p", { role: "status", "aria-live": "polite" });
  const urdf = line("Copy the URDF origin");
  const publisher = line("Copy the command");
  const find = textButton("Find it", () => act("FindFrame", {}), {
    tip: "Move it to where its scan fits the map best: x, y and yaw",
  });
  const done = textButton("Done", end, { tip: "Return it to its published pose (Esc)" });
  const element = el(
    "section",
    { class: "wv-card wv-what-if", hidden: true, "aria-label": "What if" },
    el(
      "div",
      { class: "wv-what-if-head" },
      title,
      needs("FindFrame", find),
      needs("EndTrial", done),
    ),
    fits,
    numbers(),
    urdf.element,
    publisher.element,
  );
  watch("what_if", (values) => {
    const frame = values.get("frame");
    isTried = frame !== undefined;
    document.body.classList.toggle("wv-trying", isTried);
    set(element, { hidden: !isTried });
    if (!isTried) return;
    const who = values.get("browser") === window.webviz.browser ? "you" : "another browser";
    setText(title, `What if: ${who} moved ${frame} on all pages. Nothing is published.`);
    setText(fits, (values.get("fits") ?? []).join(". ") || BESIDE);
    urdf.show(values.get("urdf") ?? "");
    publisher.show(values.get("command") ?? "");
  });
  command({
    name: "End the what-if",
    key: "Escape",
    group: "Tools",
    needs: "EndTrial",
    isThere: () => isTried && registry.isDefault() && !why("EndTrial"),
    run: end,
  });
  return element;
}

/** The pose of the frame in its parent, to be typed, stepped or dragged; degrees as "30°". */
function numbers() {
  const problem = el("p", { class: "wv-problem", role: "alert", hidden: true });
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
        refused: (text) => showText(problem, text),
      },
    );
    return el("label", {}, el("span", {}, name), needs("MoveFrame", control.element));
  });
  return el("div", {}, el("div", { class: "wv-what-if-numbers" }, fields), problem);
}

/**
 * A line of text with a button that copies it.
 *
 * @param {string} label
 */
function line(label) {
  const text = el("code", { class: "wv-ellipsis" });
  const take = () => copyAndTell(text.textContent ?? "");
  const button = textButton("Copy", take, { "aria-label": label });
  return {
    element: el("div", { class: "wv-what-if-line" }, text, button),
    /** @param {string} value */
    show(value) {
      setText(text, value);
      set(text, { "data-tip": value });
    },
  };
}
