// Everything that can be done, by name, and what keys do in parts of the page: the one table of keys,
// and the one place that listens to them. Controls have the keys of their kind besides.

import { why } from "webviz/access.js";
import { keyOf, shortcutGroups, takesDrag, takesPart } from "webviz/keys.js";
import { toast } from "webviz/toasts.js";

/**
 * @typedef {{
 *   name: string, run: () => unknown, icon?: string, key?: string | string[], group?: string,
 *   note?: string, isHidden?: boolean, isThere?: () => boolean, isKeyHere?: () => boolean,
 *   needs?: string, inFields?: boolean, repeats?: boolean,
 * }} Command
 */

/** @import {Taker} from "webviz/keys.js" */

const TYPED =
  "input:not([type=checkbox], [type=radio], [type=range], [type=button]), textarea, select, " +
  "[contenteditable]:not([contenteditable=false])";

/** @type {Set<Command>} */
const fixed = new Set();
/** @type {Set<() => Command[]>} */
const factories = new Set();
/** @type {Set<Taker>} */
const takers = new Set();

/**
 * Adds a command; returns what takes it away.
 *
 * `{name, run}`, and if there are: `icon`; `key`, or several in a list, such as "Ctrl+Shift+s",
 * "g", "Delete", in the words of `keyOf`; `group` in the list of keys; `note`, which stands quietly
 * behind the name; `isHidden` for what has a key but is not in the list of commands; `isThere()`,
 * whether it can be done now; `isKeyHere()`, whether its key is about it there; `needs`, the command of the viewer that it sends, which a role may not
 * be allowed. A key with Ctrl that means nothing in a field is marked with
 * `inFields`, and with `repeats` one that does it again while it is held, once what it did before is
 * answered.
 *
 * @param {Command} entry
 */
export function command(entry) {
  fixed.add(entry);
  return () => fixed.delete(entry);
}

/**
 * Adds commands that come and go: `make()` returns those of the moment. Returns what ends it.
 *
 * @param {() => Command[]} make
 */
export function provide(make) {
  factories.add(make);
  return () => factories.delete(make);
}

/**
 * Lets `take(event)` have keys before commands: it says whether it took one. Returns what ends it.
 *
 * @param {Taker} take
 */
export function takeKeys(take) {
  takers.add(take);
  return () => takers.delete(take);
}

/** All keys by group: what they do, and which they are. */
export function keyTable() {
  /** @type {Map<string, Map<string, string[]>>} */
  const table = new Map();
  const rows = [
    ...registry().map((one) => ({
      group: one.group ?? "Tools",
      does: one.name,
      keys: keysOf(one),
    })),
    ...[...shortcutGroups()].flatMap(([group, all]) => all.map((one) => ({ group, ...one }))),
  ];
  for (const { group, does, keys } of rows.filter((row) => row.keys.length)) {
    const own = table.get(group) ?? new Map();
    table.set(group, own.set(does, [...(own.get(does) ?? []), ...keys]));
  }
  return table;
}

/** All commands, also those that cannot be done now. */
export const registry = () => [...fixed, ...[...factories].flatMap((make) => make())];

/** All commands that can be done now. */
export const all = () => registry().filter(({ isThere }) => !isThere || isThere());

/**
 * Does what a command is for, or says why that is not allowed.
 *
 * @param {Pick<Command, "needs" | "run">} command
 */
export function run({ needs, run: act }) {
  const reason = needs ? why(needs) : "";
  if (reason) toast(reason, { level: "warn", topic: "access" });
  else return act();
}

/**
 * The keys of a command, in a list.
 *
 * @param {Command} command
 */
export const keysOf = ({ key }) => (key ? [key].flat() : []);

/**
 * True if the target of an event is a text field.
 *
 * @param {{target: EventTarget | null}} event
 */
export const isTyping = ({ target }) => target instanceof Element && target.closest(TYPED) !== null;

/** @param {Event} event */
function end(event) {
  event.preventDefault();
  event.stopPropagation();
}

export function install() {
  let isWaiting = false; // for an answer before a held key does more, after an error until it is let go

  const onDrag = (/** @type {KeyboardEvent} */ event) => {
    if (!takesDrag(event)) return;
    event.preventDefault();
    event.stopImmediatePropagation();
  };
  addEventListener("keydown", onDrag, { capture: true });
  // Within viser's listeners, which are on the document and further out, and around those of
  // controls, which come first. Dialogs and menus keep their keys to themselves.
  document.body.addEventListener("keydown", (event) => {
    // Ctrl+S is a command; the camera of viser would walk as well.
    if (event.ctrlKey || event.metaKey || event.altKey) event.stopPropagation();
    if (event.defaultPrevented || event.isComposing) return;
    const key = keyOf(event);
    const isInField = isTyping(event);
    if (takesPart(event) || (!isInField && [...takers].some((take) => take(event)))) {
      end(event);
      return;
    }
    /** @param {Command} one */
    const matches = (one) =>
      keysOf(one).includes(key) && (!isInField || one.inFields) && (one.isKeyHere?.() ?? true);
    // As in RViz, the last one with a key has it.
    const match = all().findLast(matches);
    if (!match) return;
    end(event);
    if (event.repeat && (!match.repeats || isWaiting)) return;
    // What was typed counts before anything is saved.
    if (isInField) /** @type {HTMLElement} */ (document.activeElement).blur();
    isWaiting = true;
    Promise.resolve(run(match)).then((answer) => {
      isWaiting = /** @type {any} */ (answer)?.level === "error";
    });
  });
}
