// The messages that turn one state of the scene into another, in any direction of time.
//
// A state is the set of messages that a browser would receive that joins then. Those of one node come
// together: the one that creates it, and changes, each of which has a key.

/** @import {MessageFacts} from "webviz/recorded/types.js" */

/** @typedef {{create: MessageFacts | null, changes: Map<string, MessageFacts>}} Node */

/** @type {Node} */
const NOTHING = { create: null, changes: new Map() };

/**
 * By node, "" for the scene as a whole. A node that was removed has nothing.
 *
 * @param {Iterable<MessageFacts>} messages in order
 */
function byNode(messages) {
  /** @type {Map<string, Node>} */
  const nodes = new Map();
  for (const message of messages) {
    const { key, node: name, phase } = message;
    if (phase === "remove") continue;
    let node = nodes.get(name);
    if (!node) nodes.set(name, (node = { create: null, changes: new Map() }));
    if (phase === "create" && name !== "") node.create = message;
    else node.changes.set(key, message);
  }
  return nodes;
}

/**
 * The nodes to remove, and then the numbers of the messages to apply, both in order.
 *
 * @param {Iterable<MessageFacts>} before in order
 * @param {Iterable<MessageFacts>} after likewise
 */
export function changesBetween(before, after) {
  const [old, next] = [byNode(before), byNode(after)];
  /** @type {Set<string>} */
  const deletions = new Set();
  /** @type {number[]} */
  const updates = [];
  // Parents come before what is below them, which goes with them.
  for (const name of [...new Set([...old.keys(), ...next.keys()])].sort()) {
    const from = isBelow(name, deletions) ? NOTHING : (old.get(name) ?? NOTHING);
    const to = next.get(name) ?? NOTHING;
    // A page cannot take back a change, but make the node anew.
    const isStale = [...from.changes.keys()].some((key) => !to.changes.has(key));
    if (from.create && (!to.create || isStale)) deletions.add(name);
    const isNew =
      to.create !== null && (from.create?.number !== to.create.number || deletions.has(name));
    if (isNew && to.create) updates.push(to.create.number);
    for (const [key, { number }] of to.changes) {
      if (isNew || from.changes.get(key)?.number !== number) updates.push(number);
    }
  }
  return { deletions: [...deletions], updates: updates.sort((a, b) => a - b) };
}

/**
 * True if a node is below one of some others.
 *
 * @param {string} name
 * @param {Set<string>} others
 */
function isBelow(name, others) {
  if (!others.size) return false;
  for (let end = name.lastIndexOf("/"); end > 0; end = name.lastIndexOf("/", end - 1)) {
    if (others.has(name.slice(0, end))) return true;
  }
  return false;
}
