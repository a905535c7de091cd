// The tools in the toolbar: their buttons and keys, and the pointer while one is active.

import { el, set, setChildren } from "../dom.js";
import * as gesture from "../handles/gesture.js";
import * as glow from "../handles/glow.js";
import { icon } from "../icons.js";
import { listeners } from "../listeners.js";
import { focusCamera, interact, moveCamera } from "../tools/camera.js";
import { hint, tell } from "../tools/hint.js";
import { measure } from "../tools/measure.js";
import * as registry from "../tools/registry.js";
import * as selecting from "../tools/select.js";
import * as preview from "../tools/preview.js";
import { canvas } from "../viser_page.js";
import { command, provide } from "./commands.js";
import { keyText } from "./keys.js";

/** @import {SceneEvent, Tool} from "../types.js" */

/** The buttons of the tools; those that are icons may go into a menu. */
export const buttons = el("div", { class: "wv-tools", role: "group", "aria-label": "Tools" });
export const icons = el("div", { class: "wv-tools", role: "group", "aria-label": "Camera" });
/** The area below the toolbar, which features fill. */
export const cards = el("div", { class: "wv-cards" });
export { hint };

const EVENTS = /** @type {const} */ ([
  "pointerdown",
  "pointermove",
  "pointerup",
  "pointercancel",
  "wheel",
]);
const changes = listeners();
/** @type {Map<string, HTMLButtonElement>} */
const made = new Map();
/** @type {Tool | null} */
let active = null;

/** Calls a listener whenever there are other tools. */
export const onTools = changes.on;

export function install() {
  registry.onChange(update);
  registry.setDefault(interact);
  registry.provide("page", [interact, moveCamera, selecting.select, focusCamera, measure]);
  gesture.install();
  glow.install();
  selecting.install();
  provide(() =>
    registry.all().map((tool) => ({
      name: tool.name,
      icon: tool.icon,
      key: tool.shortcut || undefined,
      group: "Tools",
      run: () => registry.toggle(tool),
    })),
  );
  command({
    name: "Leave the tool",
    key: "Escape",
    group: "Tools",
    isHidden: true,
    isThere: () => !registry.isDefault(),
    run: () => registry.select(null),
  });
  command({
    name: "Send",
    key: "Enter",
    group: "Tools",
    isHidden: true,
    run: preview.send,
    isThere: () => preview.isWaiting() && !document.activeElement?.closest("button"),
  });
  for (const name of EVENTS) {
    window.addEventListener(name, onPointer, { capture: true, passive: false });
  }
}

function update() {
  if (active !== registry.active()) {
    active = registry.active();
    tell("hint", active?.hint ?? "");
  }
  const count = () => icons.children.length + buttons.children.length;
  const before = count();
  const [lean, named] = [true, false].map((isLean) =>
    registry.all().filter((tool) => Boolean(tool.isLean) === isLean),
  );
  setChildren(icons, lean.map(buttonOf));
  setChildren(buttons, named.map(buttonOf));
  if (count() !== before) changes.tell();
}

/** The tools that are icons, as items of a menu. */
export const iconItems = () =>
  registry
    .all()
    .filter(({ isLean }) => isLean)
    .map((tool) => ({
      label: tool.name,
      icon: tool.icon,
      key: tool.shortcut,
      checked: tool === registry.active(),
      run: () => registry.toggle(tool),
    }));

/** @param {Tool} tool */
function buttonOf(tool) {
  const button = made.get(tool.id) ?? el("button", { type: "button", class: "wv-tool" });
  made.set(tool.id, button);
  const { name, tooltip, shortcut, isLean, refusal } = tool;
  const text = JSON.stringify([name, tooltip, shortcut, refusal]);
  if (button.dataset.tool !== text) {
    button.dataset.tool = text;
    set(button, {
      "aria-label": name,
      "data-tip": `${name}: ${refusal || tooltip}`,
      "aria-disabled": refusal ? "true" : null,
      "data-key": shortcut || null,
    });
    const key = shortcut ? [el("kbd", {}, keyText(shortcut))] : [];
    button.replaceChildren(
      icon(tool.icon),
      ...(isLean ? [] : [el("span", { class: "wv-tool-name" }, name), ...key]),
    );
  }
  button.onclick = () => registry.toggle(tool);
  set(button, { "aria-pressed": String(tool.id === registry.active()?.id) });
  return button;
}

/** @param {SceneEvent} event */
function onPointer(event) {
  if (event.type === "pointerdown" && event.target !== canvas()) return;
  if (registry.active()?.pointer?.(event)) event.stopImmediatePropagation();
}
