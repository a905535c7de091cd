// The tools of this page, and the one that is active; each browser has its own.
//
// A tool is `{id, name, tooltip, shortcut, icon, hint}`, with, as far as it needs them: `refusal`, a
// sentence on why it cannot be used; `cursor`; `order`, its place among the others; `select()`,
// called when it becomes active, and `leave()`, when it is not any more; `pointer(event)`, which
// gets the pointer's events over the scene before the camera and returns whether it took them;
// `isLean`, whether its button is an icon only.
// Moving the camera is the default, until a feature has another.

import { batch, computed, effect, root, signal } from "webviz/signals.js";
import { canvas } from "webviz/viser_page.js";
import { showHint } from "webviz/tools/hint.js";

/** @import {End, Tool} from "webviz/types.js" */

const sets = signal(/** @type {Map<string, Tool[]>} */ (new Map()));
const ordered = computed(() => [...sets.value.values()].flat().sort((a, b) => a.order - b.order));
const fallback = signal(/** @type {Tool | null} */ (null));
const current = signal(/** @type {Tool | null} */ (null));

/**
 * Replaces the tools that come from one origin. A gesture goes on if its tool is still there.
 *
 * @param {string} origin
 * @param {Tool[]} tools
 * @returns {void}
 */
export function provide(origin, tools) {
  const refusal = batch(() => {
    sets.value = new Map(sets.value).set(origin, tools);
    const before = current.value;
    if (!before || all().includes(before)) return;
    const same = all().find((tool) => tool.id === before.id);
    if (same && !same.refusal) current.value = same;
    else select(null);
    return same?.refusal;
  });
  if (refusal) showHint("warn", refusal); // in place of the hint of the tool that is active now
}

/** All tools in the order of the toolbar. */
export const all = () => ordered.value;

export const active = () => current.value;
export const isDefault = () => current.value === fallback.value;

/**
 * Makes a tool the one to go back to. It is active if the one before was.
 *
 * @param {Tool} tool
 */
export const setDefault = (tool) =>
  batch(() => {
    if (isDefault()) current.value = tool;
    fallback.value = tool;
  });

/**
 * Selects a tool; null is the default. One that cannot be used says why.
 *
 * @param {Tool | null} tool
 * @returns {void}
 */
export function select(tool) {
  if (tool?.refusal) return showHint("warn", tool.refusal);
  batch(() => {
    current.value?.leave?.();
    current.value = tool ?? fallback.value;
    canvas().style.cursor = current.value?.cursor ?? "";
    current.value?.select?.();
  });
}

/**
 * Selects a tool, or goes back if it is selected.
 *
 * @param {Tool} tool
 */
export const toggle = (tool) => select(tool === current.value ? null : tool);

/**
 * Calls a listener when tools change or another one is active; returns what ends it.
 *
 * @param {() => void} listener
 * @returns {End}
 */
export function onChange(listener) {
  let isFirst = true;
  return effect(() => {
    if (all() && active() !== undefined && !isFirst) root(listener); // what it makes stays
    isFirst = false;
  });
}
