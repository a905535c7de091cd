// The head of the side: the config file, and what is done with it.

import { el } from "../dom.js";
import { iconButton } from "../icons.js";
import { actions, added, item, submenuItems } from "./actions.js";
import * as files from "./files.js";
import { fold, openPanel } from "../docks/layout.js";
import { openMenuBelow } from "../controls/menu.js";
import { isSevere } from "../panels/findings.js";
import { effect } from "../signals.js";
import { store } from "../stores.js";
import { roleMark } from "./people.js";
import { theme } from "./theme.js";
import { setTitle } from "../title.js";

/** @import {MenuItem} from "../controls/menu.js" */

const ofFeatures = el("span", { class: "wv-head-buttons" });

/**
 * Adds a button of a feature.
 *
 * @param {HTMLElement} button
 */
export const headButton = (button) => ofFeatures.append(button);

export function build() {
  /** @type {HTMLButtonElement} */
  const name = el(
    "button",
    {
      type: "button",
      class: "wv-file",
      "aria-haspopup": "menu",
      "data-tip": () => (files.isThere() ? files.path() || "Not yet saved in a file" : null),
      onclick: () => openMenuBelow(name, fileMenu()),
    },
    () => (files.isThere() ? files.fileName() || "webviz" : "Connecting…"),
  );
  effect(() => {
    const title = [files.fileName(), "webviz"].filter(Boolean).join(" · ");
    if (files.isThere()) setTitle(files.isChanged() ? `* ${title}` : title);
  });
  /** @type {HTMLButtonElement} */
  const more = iconButton("dots", "Menu", () => openMenuBelow(more, menu()), {
    "aria-haspopup": "menu",
  });
  return el(
    "header",
    { class: "wv-head" },
    name,
    el("span", {
      class: "wv-mark",
      role: "img",
      "aria-label": "Unsaved changes",
      "data-tip": "Unsaved changes",
      hidden: () => !files.isChanged(),
    }),
    roleMark(),
    el("span", { class: "wv-gap" }),
    badge(),
    iconButton("search", "Commands", actions.commands.run, { "data-key": "Ctrl+k" }),
    ofFeatures,
    more,
    iconButton("fold", "Hide the panels", () => fold(true), { "data-key": "Ctrl+b" }),
  );
}

// The number of findings, while there are any.
function badge() {
  const findings = store("findings");
  const severe = () => (findings.get("all") ?? []).filter(isSevere);
  const count = () => String(severe().length);
  const cause = () => severe()[0]?.cause;
  return el(
    "button",
    {
      type: "button",
      class: "wv-icon wv-doctor-badge",
      hidden: () => !severe().length,
      "data-level": () => severe()[0]?.level,
      "aria-label": () => `Doctor: ${count() === "1" ? "1 finding" : `${count()} findings`}`,
      "aria-description": cause,
      "data-tip": cause,
      onclick: () => openPanel("doctor"),
    },
    el("span", { class: "wv-dot", "aria-hidden": "true" }),
    el("span", {}, count),
  );
}

/** @returns {(MenuItem | null)[]} */
const fileMenu = () => [
  item(actions.save),
  item(actions.saveAs),
  item(actions.open),
  null,
  item(actions.yaml),
  item(actions.rviz),
];

/** @returns {(MenuItem | null)[]} */
function menu() {
  /** @param {string} name */
  const isTheme = (name) => ({ checked: theme() === name });
  return [
    ...fileMenu(),
    null,
    item(actions.image),
    item(actions.video),
    item(actions.fullscreen, { checked: document.fullscreenElement ? true : undefined }),
    ...submenuItems(),
    item(actions.people),
    ...added.map((action) => item(action)),
    null,
    item(actions.dark, isTheme("dark")),
    item(actions.light, isTheme("light")),
    item(actions.system, isTheme("system")),
    null,
    item(actions.keys),
  ];
}
