// Commands of the page's frame; the header and its menu are made of them.

import { act } from "webviz/act.js";
import { openAdd } from "webviz/panels/displays/add.js";
import { openCommandList } from "webviz/shell/command_list.js";
import { command } from "webviz/commands.js";
import { openKeys } from "webviz/shell/key_help.js";
import { fold } from "webviz/docks/layout.js";
import { setTheme } from "webviz/shell/theme.js";
import { toggle } from "webviz/shell/video.js";

/** @import {Command} from "webviz/commands.js" */
/** @import {MenuItem} from "webviz/controls/menu.js" */

/**
 * Keys are RViz's where a browser leaves them to a page. Not those of RViz that open a window,
 * reload or close a tab in a browser (Ctrl+N, R, X), nor W, A, S, D, Q, E and arrows, which move
 * the camera.
 *
 * @type {Record<string, Command & {icon: string}>}
 */
export const actions = {
  image: { name: "Save image", icon: "camera", group: "View", run: () => act("SaveImage") },
  video: {
    name: "Record or stop a video",
    icon: "record",
    group: "View",
    run: () => toggle(),
  },
  add: {
    name: "Add display…",
    icon: "plus",
    key: "Insert",
    group: "Edit",
    needs: "AddDisplay",
    run: () => openAdd(),
  },
  fullscreen: { name: "Full screen", icon: "fullscreen", group: "View", run: toggleFullScreen },
  fold: {
    name: "Show or hide the panels",
    icon: "sidebar",
    key: "Ctrl+b",
    group: "View",
    run: () => fold(),
  },
  dark: { name: "Theme: dark", icon: "moon", group: "View", run: () => setTheme("dark") },
  light: { name: "Theme: light", icon: "sun", group: "View", run: () => setTheme("light") },
  system: {
    name: "Theme: as the system",
    icon: "screen",
    group: "View",
    run: () => setTheme("system"),
  },
  commands: {
    name: "Commands",
    icon: "search",
    key: ["Ctrl+k", "Ctrl+Shift+p"],
    inFields: true,
    isHidden: true,
    group: "Help",
    run: () => openCommandList(),
  },
  keys: {
    name: "Keyboard shortcuts",
    icon: "keyboard",
    key: "?",
    group: "Help",
    run: () => openKeys(),
  },
};

/** Actions of features, which the menu has, too. @type {(Command & {order?: number})[]} */
export const added = [];

const LAST = 1000;

/** @param {Command & {order?: number}} entry with its place among the others, the last without it */
export function action(entry) {
  added.push(entry);
  added.sort((a, b) => (a.order ?? LAST) - (b.order ?? LAST));
  command(entry);
}

/** @type {(() => (MenuItem | null)[])[]} */
const starts = [];

/**
 * Adds entries at the beginning of the menu.
 *
 * @param {() => (MenuItem | null)[]} make those of the moment, whenever it opens
 */
export const menuStart = (make) => starts.push(make);

/** @returns {(MenuItem | null)[]} */
export const menuStarts = () => starts.flatMap((make) => [...make(), null]);

/** Further menus of the menu, of features. @type {{label: string, icon: string, make: () => (MenuItem | null)[]}[]} */
const submenus = [];

/**
 * Adds a menu to the menu.
 *
 * @param {string} label
 * @param {string} icon
 * @param {() => (MenuItem | null)[]} make its entries, whenever it opens
 */
export const submenu = (label, icon, make) => submenus.push({ label, icon, make });

/** @returns {MenuItem[]} */
export const submenuItems = () =>
  submenus.map(({ label, icon, make }) => ({ label, icon, items: make() }));

export function install() {
  for (const action of Object.values(actions))
    command(Object.assign(action, { group: action.group ?? "File" }));
}

/**
 * An action as an item of a menu, with what is different there.
 *
 * @param {Command} action
 * @param {Partial<MenuItem>} [more]
 * @returns {MenuItem}
 */
export const item = ({ name, icon, key, run, needs }, more = {}) => ({
  label: name,
  icon,
  key: [key].flat()[0],
  run,
  needs,
  ...more,
});

function toggleFullScreen() {
  if (document.fullscreenElement) document.exitFullscreen();
  else document.documentElement.requestFullscreen();
}
