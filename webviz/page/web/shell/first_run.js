// First steps: shown while nothing is published at all, and beside the demo's robot.

import { copy } from "webviz/clipboard.js";
import * as commands from "webviz/commands.js";
import { el } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { recall, remember } from "webviz/remember.js";
import { signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";

/** @import {Child} from "webviz/types.js" */

const COMMAND = "webviz-sim";

/**
 * @param {HTMLElement} scene
 * @param {HTMLElement} cards
 */
export function install(scene, cards) {
  const graph = store("graph");
  const isEmpty = () => graph.get("is_empty") === true;
  card(scene, "knows-first-run", "Nothing is published yet", isEmpty, nothing());
  const hasSimulator = () => graph.get("has_simulator") === true;
  card(cards, "knows-demo", "Three things to try", hasSimulator, thingsToTry());
}

/**
 * A card over the scene, which goes for good when it is closed.
 *
 * @param {HTMLElement} scene
 * @param {string} key under which the browser remembers that
 * @param {string} title
 * @param {() => boolean} isThere
 * @param {Child | Child[]} content
 */
function card(scene, key, title, isThere, content) {
  const isKnown = signal(recall(key, false));
  const close = () => remember(key, (isKnown.value = true));
  const head = el(
    "header",
    {},
    el("h2", {}, title),
    iconButton("close", "Close", close, { tip: null }),
  );
  scene.append(
    el(
      "section",
      {
        class: "wv-first-run",
        "aria-label": title,
        hidden: () => isKnown.value || !isThere(),
      },
      el("div", { class: "wv-card" }, head, content),
    ),
  );
}

const nothing = () => [
  el("p", {}, "Start your robot, a simulator or a bag: its topics appear here by themselves."),
  el("p", {}, "For a robot to try things with, run this in a terminal:"),
  el(
    "p",
    { class: "wv-command" },
    el("code", {}, COMMAND),
    iconButton("copy", "Copy the command", () => copy(COMMAND), { tip: "Copy" }),
  ),
];

const thingsToTry = () =>
  el(
    "ol",
    {},
    thing("Send the robot somewhere", "2D Goal Pose", "and drag on the map."),
    thing("Look back", "5 s back", "or drag the time below, then return to live."),
    thing("Find anything", "Commands", "for displays, topics, views and settings."),
  );

/**
 * @param {string} title
 * @param {string} name of a command
 * @param {string} text
 */
function thing(title, name, text) {
  const find = () => commands.registry().find((one) => one.name === name);
  const start = () => {
    const entry = find();
    if (entry) commands.run(entry);
  };
  return el(
    "li",
    {},
    el("b", {}, title),
    el(
      "p",
      {},
      el("button", { type: "button", class: "wv-link", onclick: start }, name),
      ` ${text}`,
    ),
  );
}
