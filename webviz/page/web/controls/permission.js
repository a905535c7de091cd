// The right to use a topic, service or action, where its form is: the owner allows it there, others
// see whose permission it needs and ask for it.

import { self, why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { el } from "webviz/dom.js";
import { textButton } from "webviz/icons.js";
import { store } from "webviz/stores.js";

const LOOPBACK = /^(localhost|127(\.\d+){3}|\[::1\])$/;

/**
 * `isRefused()`: whether it may not be used until an owner allows it; to be read in effects.
 *
 * @typedef {{element: HTMLElement, isRefused: () => boolean}} Permission
 */

/**
 * The right to use a name, as far as the page knows it.
 *
 * @param {() => string} name full, "" for none
 */
function rightTo(name) {
  const values = () => store(`permission:${name()}`);
  const refusal = () => (name() ? (values().get("refusal") ?? "") : "");
  const mine = () => window.webviz.browser ?? -1;
  return {
    refusal,
    isOpen: () => Boolean(refusal()) && values().get("is_open") === true,
    isAllowed: () => Boolean(name()) && values().get("is_allowed") === true,
    file: () => values().get("file") ?? "",
    isAsked: () => (values().get("requests") ?? []).includes(mine()),
    isDeclined: () => (values().get("declined") ?? []).includes(mine()),
  };
}

/**
 * The notice for one name, hidden while there is nothing to say.
 *
 * @param {{name: () => string, use: () => string}} options `name`: full, "" for none; `use`: such as
 *   "call /calibrate"
 * @returns {Permission}
 */
export function permission({ name, use }) {
  const right = rightTo(name);
  const isOwner = !why("Allow");
  const isHere = LOOPBACK.test(location.hostname);
  const sentence = () => {
    if (right.isAllowed()) return "Allowed for this session.";
    if (!right.isOpen()) return right.refusal();
    return `This viewer may not ${use()} yet.${remedy({ right, name, isOwner, isHere })}`;
  };
  /** @param {boolean} always */
  const allow = (always) => act("Allow", { name: name(), always });
  const isOffered = () => isOwner && isHere && right.isOpen();
  const element = el(
    "section",
    {
      class: "wv-permission",
      "aria-label": "Permission",
      hidden: () => !right.refusal() && !right.isAllowed(),
      "data-allowed": right.isAllowed,
    },
    el("span", { role: "status" }, sentence),
    textButton("Allow for this session", () => allow(false), {
      class: "wv-button wv-primary",
      hidden: () => !isOffered(),
    }),
    el(
      "button",
      {
        type: "button",
        class: "wv-button",
        hidden: () => !isOffered() || !right.file(),
        "data-tip":
          "Allows it from the next start on, too, and saves the file with all its changes",
        onclick: () => allow(true),
      },
      () => `Always, in ${right.file()}`,
    ),
    textButton("Ask the owner", () => act("AskOwner", { name: name() }), {
      class: "wv-button wv-primary",
      hidden: () => isOwner || Boolean(why("AskOwner")) || !right.isOpen() || right.isAsked(),
    }),
    textButton("Take back", () => act("Forbid", { name: name() }), {
      class: "wv-link",
      hidden: () => !isOwner || !right.isAllowed(),
    }),
  );
  return { element, isRefused: () => Boolean(right.refusal()) };
}

/**
 * Return who can allow it, for those who cannot, as a sentence behind another.
 *
 * @param {{right: ReturnType<typeof rightTo>, name: () => string, isOwner: boolean, isHere: boolean}} options
 */
function remedy({ right, name, isOwner, isHere }) {
  if (isOwner) {
    const elsewhere =
      " Allow it in a page on the viewer's own machine, or restart the viewer with " +
      `--allow-publish ${name()}.`;
    return isHere ? "" : elsewhere;
  }
  if (right.isDeclined()) return " The owner declined for now.";
  if (right.isAsked()) return " The owner has been asked.";
  return self().role === "watcher"
    ? " Its owner can allow it to operators."
    : " Its owner can allow it.";
}
