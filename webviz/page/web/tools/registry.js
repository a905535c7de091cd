// The tools of this page, and the one that is active; each browser has its own.
//
// A tool is `{id, name, tooltip, shortcut, icon, hint}`, with, as far as it needs them: `refusal`, a
// sentence on why it cannot be used; `cursor`; `order`, its place among the others; `select()`,
// called when it becomes active, and `leave()`, when it is not any more; `pointer(event)`, which
// gets the pointer's events over the scene before the camera and returns whether it took them;
// `isLean`, whether its button is an icon only.
// Interact is the default.

import { listeners } from "../listeners.js";
import { canvas } from "../viser_page.js";
import { tell } from "./hint.js";

/** @import {Tool} from "../types.js" */

const changes = listeners();
/** @type {Map<string, Tool[]>} */
const sets = new Map();
/** @type {Tool | null} */
let fallback = null;
/** @type {Tool | null} */
let current = null;

/**
 * Replaces the tools that come from one origin. A gesture goes on if its tool is still there.
 *
 * @param {string} origin
 * @param {Tool[]} tools
 * @returns {void}
 */
export function provide(origin, tools) {
  sets.set(origin, tools);
  const known = all();
  const id = current?.id;
  if (!current || known.includes(current)) return changes.tell();
  const same = known.find((tool) => tool.id === id);
  if (same && !same.refusal) {
    current = same;
    return changes.tell();
  }
  select(null);
  if (same?.refusal) tell("warn", same.refusal);
}

/** All tools in the order of the toolbar. */
export const all = () => [...sets.values()].flat().sort((a, b) => a.order - b.order);

export const active = () => current;
export const isDefault = () => current === fallback;

/**
 * Makes a tool the one to go back to.
 *
 * @param {Tool} tool
 */
export function setDefault(tool) {
  fallback = current = tool;
}

/**
 * Selects a tool; null is the default. One that cannot be used says why.
 *
 * @param {Tool | null} tool
 * @returns {void}
 */
export function select(tool) {
  if (tool?.refusal) return tell("warn", tool.refusal);
  current?.leave?.();
  current = tool ?? fallback;
  canvas().style.cursor = current?.cursor ?? "";
  current?.select?.();
  changes.tell();
}

/**
 * Selects a tool, or goes back if it is selected.
 *
 * @param {Tool} tool
 */
export const toggle = (tool) => select(tool === current ? null : tool);

/** Calls a listener when tools change or another one is active; returns what ends it. */
export const onChange = changes.on;
