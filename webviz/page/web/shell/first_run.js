// First steps, shown while nothing is published at all.

import { copy } from "../clipboard.js";
import { el } from "../dom.js";
import { iconButton } from "../icons.js";
import { recall, remember } from "../remember.js";
import { watch } from "../stores.js";

const COMMAND = "webviz-sim";

/** @param {HTMLElement} scene */
export function install(scene) {
  if (recall("knows-first-run", false)) return;
  const close = () => {
    remember("knows-first-run", true);
    card.remove();
    end();
  };
  const copyButton = iconButton("copy", "Copy the command", () => copy(COMMAND), { tip: "Copy" });
  const card = el(
    "section",
    { class: "wv-first-run", "aria-label": "Nothing is published", hidden: true },
    el(
      "div",
      { class: "wv-card" },
      el(
        "header",
        {},
        el("h2", {}, "Nothing is published yet"),
        iconButton("close", "Close", close, { tip: null }),
      ),
      el("p", {}, "Start your robot, a simulator or a bag: its topics appear here by themselves."),
      el("p", {}, "For a robot to try things with, run this in a terminal:"),
      el("p", { class: "wv-command" }, el("code", {}, COMMAND), copyButton),
    ),
  );
  scene.append(card);
  const end = watch("graph", (graph) => {
    card.hidden = !graph.get("is_empty");
  });
}
