// History of what this page has sent by tools, with the results: the newest first.

import * as act from "webviz/act.js";
import { effect, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";

/** @import {MadeGesture, ToolFacts} from "webviz/types.js" */
/** @import {Published} from "webviz/messages.js" */

/** @typedef {{topic: string, type: string, values: Published["values"]}} SentMessage */

/**
 * @typedef {Required<MadeGesture> & {
 *     number: number, tool: ToolFacts, frame: string, time: Date,
 *     level: string, text: string, messages: SentMessage[],
 *   }} SentGesture
 */

const MAX_KEPT = 20;

const entries = signal(/** @type {SentGesture[]} */ ([]));
const settings = store("settings");

export function install() {
  effect(fixedFrame); // which is there whenever something is sent
}

/** All entries; read in effects. */
export const all = () => entries.value;

/** The fixed frame of now. */
export function fixedFrame() {
  return settings.get("fixed_frame") ?? "";
}

/**
 * Sends a finished gesture of a tool, `{id, name, gesture}`, or poses that were collected.
 *
 * @param {ToolFacts} tool
 * @param {MadeGesture} made
 */
export function send(tool, { points, yaw, keys, yaws = [], several = "" }) {
  const gesture = { points, yaw, keys, yaws, several };
  const result = { level: "", text: "", messages: [] };
  const number = act.send("UseTool", { tool: tool.id, ...gesture });
  const entry = { number, tool, ...gesture, frame: fixedFrame(), time: new Date(), ...result };
  entries.value = [entry, ...entries.value].slice(0, MAX_KEPT);
}

/**
 * Sends it again: a new message, stamped now.
 *
 * @param {SentGesture} entry
 */
export const again = (entry) => send(entry.tool, entry);

/**
 * Note the result of a gesture, a sentence.
 *
 * @param {number} number
 * @param {string} level
 * @param {string} text
 */
export const setOutcome = (number, level, text) =>
  change(number, (entry) => ({ ...entry, level, text }));

/**
 * A message that a gesture became: `{topic, type, values}`.
 *
 * @param {number} number
 * @param {SentMessage} message
 */
export const published = (number, message) =>
  change(number, (entry) => ({ ...entry, messages: [...entry.messages, message] }));

/**
 * @param {number} number
 * @param {(entry: SentGesture) => SentGesture} update
 */
function change(number, update) {
  entries.value = entries.value.map((entry) => (entry.number === number ? update(entry) : entry));
}
