// The head of the side: what features put there, and the menu.

import { onRole, self } from "webviz/access.js";
import { el } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { actions, added, item, menuStarts, submenuItems } from "webviz/shell/actions.js";
import { fold } from "webviz/docks/layout.js";
import { openMenuBelow } from "webviz/controls/menu.js";
import { theme } from "webviz/shell/theme.js";

/** @import {MenuItem} from "webviz/controls/menu.js" */

const lead = el("span", { class: "wv-head-buttons" });
const marks = el("span", { class: "wv-head-buttons" });
const ofFeatures = el("span", { class: "wv-head-buttons" });

/**
 * Adds what the head begins with, such as the name of what is shown.
 *
 * @param {...HTMLElement} elements
 */
export const headStart = (...elements) => lead.append(...elements);

/**
 * Adds what the buttons begin with, such as a number that is there while it is not zero.
 *
 * @param {HTMLElement} mark
 */
export const headMark = (mark) => marks.append(mark);

/**
 * Adds a button of a feature.
 *
 * @param {HTMLElement} button
 */
export const headButton = (button) => ofFeatures.append(button);

export function build() {
  /** @type {HTMLButtonElement} */
  const more = iconButton("dots", "Menu", () => openMenuBelow(more, menu()), {
    "aria-haspopup": "menu",
  });
  return el(
    "header",
    { class: "wv-head" },
    lead,
    roleMark(),
    el("span", { class: "wv-gap" }),
    marks,
    iconButton("search", "Commands", actions.commands.run, { "data-key": "Ctrl+k" }),
    ofFeatures,
    more,
    iconButton("fold", "Hide the panels", () => fold(true), { "data-key": "Ctrl+b" }),
  );
}

/** A word on the role of this page, for those who are not the owner. */
function roleMark() {
  const mark = el("span", { class: "wv-role", hidden: true });
  onRole(() => {
    const { role, name } = self();
    mark.hidden = role === "owner";
    mark.textContent = role;
    mark.dataset.tip = `Your link${name ? `, ${name},` : ""} is for ${role === "operator" ? "an" : "a"} ${role}.`;
  });
  return mark;
}

/** @returns {(MenuItem | null)[]} */
function menu() {
  /** @param {string} name */
  const isTheme = (name) => ({ checked: theme() === name });
  return [
    ...menuStarts(),
    item(actions.image),
    item(actions.video),
    item(actions.fullscreen, { checked: document.fullscreenElement ? true : undefined }),
    ...submenuItems(),
    ...added.map((action) => item(action)),
    null,
    item(actions.dark, isTheme("dark")),
    item(actions.light, isTheme("light")),
    item(actions.system, isTheme("system")),
    null,
    item(actions.keys),
  ];
}
