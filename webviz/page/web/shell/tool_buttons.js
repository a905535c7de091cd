// The tools in the toolbar: their buttons and keys, and the pointer while one is active.

import { el } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { focusCamera, moveCamera } from "webviz/tools/camera_tools.js";
import { hint, showHint } from "webviz/tools/hint.js";
import { measure } from "webviz/tools/measure.js";
import * as registry from "webviz/tools/registry.js";
import * as preview from "webviz/tools/preview.js";
import { recall, remember } from "webviz/remember.js";
import { each, effect } from "webviz/signals.js";
import { canvas } from "webviz/viser_page.js";
import { command, provide } from "webviz/commands.js";
import { keyText } from "webviz/keys.js";

/** @import {Signal} from "webviz/signals.js" */
/** @import {SceneEvent, Tool} from "webviz/types.js" */

const USES = "tool-uses";
const LEARNED = 3;

/** True until the user has chosen tools here: then icons are enough. */
export const isNew = () => recall(USES, 0) < LEARNED;
/** All tools in the order of the toolbar; read in effects. */
export const all = registry.all;
/** True if there are tools besides those that are icons. */
export const hasButtons = () => all().some(({ isLean }) => !isLean);

/** The buttons of the tools; those that are icons may go into a menu. */
export const buttons = group("Tools", (tool) => !tool.isLean);
export const icons = group("Camera", (tool) => tool.isLean === true);
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

export function install() {
  registry.setDefault(moveCamera);
  registry.provide("page", [moveCamera, focusCamera, measure()]);
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
  effect(() => showHint("hint", registry.active()?.hint ?? ""));
  for (const name of EVENTS) {
    window.addEventListener(name, onPointer, { capture: true, passive: false });
  }
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

/**
 * @param {string} label
 * @param {(tool: Tool) => boolean} fits
 */
function group(label, fits) {
  const buttons = each(
    () => all().filter(fits),
    ({ id }) => id,
    buttonOf,
  );
  return el("div", { class: "wv-tools", role: "group", "aria-label": label }, buttons);
}

/** @param {Signal<Tool>} tool */
function buttonOf(tool) {
  const name = () => tool.value.name;
  const key = () => tool.value.shortcut;
  const isActive = () => tool.value.id === registry.active()?.id;
  return el(
    "button",
    {
      type: "button",
      class: () => (tool.value.isLean ? "wv-tool wv-lean" : "wv-tool"),
      "aria-label": name,
      "data-tip": () => `${name()}: ${tool.value.refusal || tool.value.tooltip}`,
      "aria-disabled": () => (tool.value.refusal ? "true" : null),
      "aria-pressed": () => String(isActive()),
      "data-key": () => key() || null,
      onclick: () => {
        registry.toggle(tool.value);
        if (isNew()) remember(USES, recall(USES, 0) + 1);
      },
    },
    () => icon(tool.value.icon),
    el("span", { class: "wv-tool-name" }, name),
    () => (tool.value.isLean || !key() ? null : el("kbd", {}, keyText(key() ?? ""))),
  );
}

/** @param {SceneEvent} event */
function onPointer(event) {
  if (event.type === "pointerdown" && event.target !== canvas()) return;
  if (registry.active()?.pointer?.(event)) event.stopImmediatePropagation();
}
