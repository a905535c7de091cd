// Clouds that come in several messages are shown as a whole: never parts of two of them together.

import * as channel from "webviz/channel.js";
import * as viser from "webviz/viser_page.js";

/** @import {ViserMessage} from "webviz/types.js" */

// By name of the cloud and version: messages by their node.
/** @type {Map<string, any>} */
const waiting = new Map();

export function install() {
  viser.filterMessages((messages) => messages.flatMap(whole));
  channel.onClose(() => waiting.clear());
}

// The messages to handle now. The server finishes a version before it begins the next.
/** @param {ViserMessage} message */
function whole(message) {
  const cloud = message.updates?.cloud;
  if (!cloud) return [message];
  const [name, version, count] = cloud;
  const versions = waiting.get(name) ?? new Map();
  const parts = versions.get(version) ?? new Map();
  parts.set(message.name, message);
  if (parts.size < count) {
    waiting.set(name, versions.set(version, parts));
    return [];
  }
  for (const each of versions.keys()) if (each <= version) versions.delete(each);
  if (!versions.size) waiting.delete(name);
  return [...parts.values()];
}
