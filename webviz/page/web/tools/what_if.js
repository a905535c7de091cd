// A static frame that is tried in another pose: a banner on every page, with the lines to copy.

import { needs, why } from "../access.js";
import { act } from "../act.js";
import { copy } from "../clipboard.js";
import { el, set, setText } from "../dom.js";
import { command } from "../shell/commands.js";
import { toast } from "../shell/toasts.js";
import { watch } from "../stores.js";
import * as registry from "./registry.js";

const BESIDE =
  "No laser scan of this frame is compared with a map: add displays of both to see how it fits.";

/**
 * Takes hold of a frame.
 *
 * @param {string} frame
 */
export function tryFrame(frame) {
  registry.select(null); // Interact, which drags handles
  act("TryFrame", { frame });
}

const end = () => act("EndTrial", {});

/** The banner; hidden while no frame is tried. */
export function whatIf() {
  let isTried = false;
  const title = el("b");
  const fits = el("p", { role: "status", "aria-live": "polite" });
  const urdf = line("Copy the URDF origin");
  const publisher = line("Copy the command");
  const find = el(
    "button",
    {
      type: "button",
      class: "wv-button",
      "data-tip": "Move it to where its scan fits the map best: x, y and yaw",
      onclick: () => act("FindFrame", {}),
    },
    "Find it",
  );
  const done = el(
    "button",
    {
      type: "button",
      class: "wv-button",
      "data-tip": "Return it to its published pose (Esc)",
      onclick: end,
    },
    "Done",
  );
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
    setText(
      title,
      `What if: ${frame} is moved by ${who}. All pages show it; nothing is published.`,
    );
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

/**
 * A line of text with a button that copies it.
 *
 * @param {string} label
 */
function line(label) {
  const text = el("code");
  const take = async () =>
    toast((await copy(text.textContent ?? "")) ? "Copied." : "The browser does not allow it.");
  const button = el(
    "button",
    { type: "button", class: "wv-button", "aria-label": label, onclick: take },
    "Copy",
  );
  return {
    element: el("div", { class: "wv-what-if-line" }, text, button),
    /** @param {string} value */
    show: (value) => setText(text, value),
  };
}
