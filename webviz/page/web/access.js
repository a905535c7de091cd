// Permissions on this page, as the server said when the page joined. The server holds every
// message against the same roles; here, what is not allowed says so before it is tried.

import * as channel from "webviz/channel.js";
import constants from "webviz/constants.js";
import { el, set } from "webviz/dom.js";
import { signal, untracked } from "webviz/signals.js";
import { toast } from "webviz/toasts.js";

/** @import {Signal} from "webviz/signals.js" */
/** @import {Attribute, Child} from "webviz/types.js" */

const ROLES = ["watcher", "operator", "owner"];
const FIELDS = "input, select, textarea, button";

/** @type {(() => void)[]} */
const waiting = []; // what was built before the server has said who this is
const you = signal(/** @type {{role: string, name: string} | null} */ (null));
/** @type {Signal<(what: string, fields: object) => string>} */
const rule = signal(byRole);

channel.on("Identity", ({ role, name }) => {
  // Another link was opened in another tab: what was built for the old role is wrong.
  if (you.value && you.value.role !== role) return location.reload();
  you.value = { role, name };
  for (const apply of waiting.splice(0)) apply();
});

/**
 * Calls `act` once the role of this page is known.
 *
 * @param {() => void} act
 */
export function onRole(act) {
  if (untracked(() => you.value)) act();
  else waiting.push(act);
}

/** The role of this page, and the name of its link: "" if none is needed. */
export const self = () => untracked(() => you.value) ?? { role: "owner", name: "" };

/**
 * Lets `refusal(what, fields)` decide what is allowed, whatever the role of this page.
 *
 * @param {(what: string, fields: object) => string} refusal a sentence, "" if it is
 */
export function decideBy(refusal) {
  rule.value = refusal;
}

/**
 * Return why a command or message is not allowed here: a sentence, "" if it is.
 *
 * @param {string} what
 * @param {object} [fields] of the command
 */
export const why = (what, fields = {}) => untracked(() => rule.value)(what, fields);

/** @param {string} what */
function byRole(what) {
  const needed = ROLES.indexOf(constants.ROLES[what]);
  const own = ROLES.indexOf(self().role);
  if (own >= needed) return "";
  const who = needed === 2 ? "the owner of this viewer" : "operators";
  return `Only ${who} may do this. Your link is for ${own === 1 ? "an operator" : "a watcher"}.`;
}

/**
 * Disables a button, or the fields of an element, if a command is not allowed; returns it.
 *
 * @template {HTMLElement} T
 * @param {string} what
 * @param {T} element
 * @returns {T}
 */
export function needs(what, element) {
  onRole(() => lock(what, element));
  return element;
}

/**
 * @param {string} what
 * @param {HTMLElement} element
 */
function lock(what, element) {
  const reason = why(what);
  if (!reason) return;
  element.classList.add("wv-locked");
  set(element, { "data-why": reason });
  if (!element.matches("button")) {
    for (const field of element.querySelectorAll(FIELDS)) {
      /** @type {HTMLButtonElement} */ (field).disabled = true;
    }
    return;
  }
  set(element, { "aria-disabled": "true" });
  /** @param {Event} event */
  const refuse = (event) => {
    event.preventDefault();
    event.stopImmediatePropagation();
    toast(reason, { level: "warn", topic: "access" });
  };
  element.addEventListener("click", refuse, true);
}

/**
 * A place for a control, in which it cannot be used if a command is not allowed.
 *
 * @param {string} what
 * @param {Record<string, Attribute>} attributes
 * @param {...(Child | Child[])} children
 */
export function holder(what, attributes, ...children) {
  const reason = what ? why(what) : "";
  if (!reason) return el("div", attributes, ...children);
  const about = { ...attributes, class: `${attributes.class} wv-locked`, "data-why": reason };
  return el("fieldset", { ...about, disabled: true }, ...children);
}
