// Displays that are switched off on this page: their nodes are hidden, and their rows say so.

import constants from "webviz/constants.js";

/** @import {DisplayRow} from "webviz/contents.js" */
/** @import {ViserMessage} from "webviz/types.js" */
/** @import {MessageFacts} from "webviz/recorded/types.js" */

const WAS_OFF = "was off when this file was made, so the file does not contain it.";
const VISIBILITY = "SetSceneNodeVisibilityMessage";

/** @typedef {Map<string, any>} Content */

/**
 * The id of the display that a group of nodes belongs to, "" for other nodes.
 *
 * @param {string} name of a node
 */
function displayOf(name) {
  const [root, group, ...rest] = name.slice(1).split("/");
  if (`/${root}` !== constants.ROOT || group === undefined || rest.length) return "";
  // Ids of displays need no encoding, whatever follows them.
  return group.split("%", 1)[0];
}

/** @param {MessageFacts} message */
const isVisibility = ({ key }) => key.endsWith(VISIBILITY);

/** @param {string} name @param {boolean} visible */
const visibility = (name, visible) => ({ type: VISIBILITY, name, visible, owner: "" });

/**
 * Returns `{set(id, enabled), content(name, content), messages(all, messages), difference(all)}`.
 */
export function switches() {
  /** @type {Map<string, boolean>} */
  const overrides = new Map(); // by id of the display
  /** @type {Set<string>} */
  let hidden = new Set(); // displays, by themselves or with their group
  /** @type {Content} */
  let recorded = new Map(); // the store "displays"

  /** @param {Content} content */
  function rows(content) {
    recorded = content;
    hidden = hiddenBy(overrides, recorded);
    return new Map([...content].map(([id, row]) => [id, switched(row, overrides.get(id))]));
  }

  return {
    /**
     * Switches a display; a sentence if that is not possible.
     *
     * @param {string} id
     * @param {boolean} enabled
     */
    set(id, enabled) {
      /** @type {DisplayRow | undefined} */
      const row = recorded.get(id);
      if (enabled && row && !row.enabled) return `${row.name} ${WAS_OFF}`;
      if (enabled) overrides.delete(id);
      else overrides.set(id, false);
      hidden = hiddenBy(overrides, recorded);
      return "";
    },
    /**
     * The values of a store as this page shows them.
     *
     * @param {string} name
     * @param {Content} content
     */
    content(name, content) {
      if (name === "displays") return rows(content);
      return hidden.size && (name === "panes" || name === "legend")
        ? without(content, hidden)
        : content;
    },
    /**
     * Messages of the scene, of which some would show what is hidden.
     *
     * @param {ViserMessage[]} messages
     */
    messages: (messages) =>
      hidden.size ? messages.flatMap((message) => hiding(message, hidden)) : messages,
    /**
     * Hides or shows the nodes of displays after a switch: messages, and numbers of recorded ones.
     *
     * @param {Iterable<MessageFacts>} all messages of the scene
     */
    difference: (all) => differenceOf(all, hidden),
  };
}

/**
 * A row as it is shown once the user has switched its display.
 *
 * @param {any} row
 * @param {boolean | undefined} isWanted undefined if the user has not
 */
const switched = (row, isWanted) =>
  isWanted === undefined ? row : { ...row, enabled: row.enabled && isWanted };

/**
 * The displays that are hidden, by themselves or with their group.
 *
 * @param {Map<string, boolean>} overrides
 * @param {Content} recorded the store "displays"
 */
function hiddenBy(overrides, recorded) {
  /** @type {Set<string>} */
  const hidden = new Set();
  /** @type {number | null} */
  let off = null;
  for (const id of recorded.get("order") ?? []) {
    /** @type {DisplayRow} */
    const row = recorded.get(id);
    if (off !== null && row.depth <= off) off = null;
    if (off === null && overrides.get(id) === false) off = row.depth;
    if (off !== null) hidden.add(id);
  }
  return hidden;
}

/**
 * The values of a store without those of displays.
 *
 * @param {Content} content
 * @param {Set<string>} hidden
 */
function without(content, hidden) {
  /** @param {string} id */
  const isShown = (id) => !hidden.has(id);
  const result = new Map([...content].filter(([id]) => isShown(id)));
  const order = content.get("order");
  if (order) result.set("order", order.filter(isShown));
  return result;
}

/**
 * A message, and what hides the node again that it would show.
 *
 * @param {ViserMessage} message
 * @param {Set<string>} hidden
 */
function hiding(message, hidden) {
  const { type, name, props } = message;
  if (typeof name !== "string" || !hidden.has(displayOf(name))) return [message];
  if (type === VISIBILITY) return [];
  return props ? [message, visibility(name, false)] : [message];
}

/**
 * @param {Iterable<MessageFacts>} all
 * @param {Set<string>} hidden
 */
function differenceOf(all, hidden) {
  /** @type {Map<string, number | null>} */
  const groups = new Map();
  for (const message of all) {
    const { node, phase, number } = message;
    if (displayOf(node) === "") continue;
    if (phase === "create" && !groups.has(node)) groups.set(node, null);
    if (isVisibility(message)) groups.set(node, number);
  }
  /** @type {ViserMessage[]} */
  const messages = [];
  /** @type {number[]} */
  const numbers = [];
  for (const [name, number] of groups) {
    if (hidden.has(displayOf(name))) messages.push(visibility(name, false));
    else if (number === null) messages.push(visibility(name, true));
    else numbers.push(number);
  }
  return { messages, numbers };
}
