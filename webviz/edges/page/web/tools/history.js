// What this page has sent by tools, and what came of it: the newest first.

import * as channel from "../channel.js";
import { watch } from "../stores.js";

const MAX_KEPT = 20;

const listeners = new Set();
let sent = [];
let count = 0;
let frame = "";

export function install() {
  watch("settings", (settings) => (frame = settings.get("fixed_frame") ?? ""));
}

export const all = () => sent;
export const fixedFrame = () => frame;

/** Calls `listener` whenever something is new; returns what ends it. */
export function onChange(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Sends a finished gesture of a tool. */
export function send({ id, name }, { points, yaw, keys }) {
  count += 1;
  const entry = {
    number: count, tool: id, name, points, yaw, keys, frame, time: new Date(), level: "", text: "", messages: [],
  };
  sent = [entry, ...sent].slice(0, MAX_KEPT);
  channel.send({ type: "StrokeDone", tool: id, points, yaw, keys, number: count });
  tellAll();
}

/** Sends it again: a new message, stamped now. */
export const again = (entry) => send({ id: entry.tool, name: entry.name }, entry);

/** What came of a gesture, in a sentence. */
export const told = (number, level, text) => change(number, (entry) => ({ ...entry, level, text }));

/** A message that a gesture became: `{topic, type, values}`. */
export const published = (number, message) =>
  change(number, (entry) => ({ ...entry, messages: [...entry.messages, message] }));

function change(number, update) {
  sent = sent.map((entry) => (entry.number === number ? update(entry) : entry));
  tellAll();
}

function tellAll() {
  for (const listener of listeners) listener();
}
