// The panel "Doctor": the causes of what is not shown, the one to repair first on top.

import { copy } from "../clipboard.js";
import { el, set, setText } from "../dom.js";
import { icon } from "../icons.js";
import { toast } from "../shell/toasts.js";
import { watch } from "../stores.js";
import { remedyButton } from "./displays/statuses.js";

const WELL = "All is well: no check has found a cause of a warning.";

/** @import {ShownFinding} from "../contents.js" */

/**
 * Returns true if a finding is more than a note.
 *
 * @param {ShownFinding} finding
 */
export const isSevere = ({ level }) => level !== "ok";

export const doctor = {
  name: "doctor",
  title: "Doctor",
  isOnDemand: true,
  /** @param {HTMLElement} element */
  open(element) {
    const list = el("ol", { class: "wv-findings", "aria-label": "Findings" });
    const empty = el("p", { class: "wv-empty", role: "status" }, WELL);
    element.append(el("section", { class: "wv-doctor", "aria-label": "Doctor" }, empty, list));
    /** @type {Set<string>} */
    const unfolded = new Set();
    let shown = "";

    return watch("findings", (values) => {
      const all = values.get("all") ?? [];
      set(empty, { hidden: all.length > 0 });
      if (JSON.stringify(all) === shown) return;
      shown = JSON.stringify(all);
      list.replaceChildren(...all.map((finding) => item(finding, unfolded)));
    });
  },
};

/**
 * @param {ShownFinding} finding
 * @param {Set<string>} unfolded
 */
function item(finding, unfolded) {
  const { id, subject, level, cause, remedy, command, explains, button, why, repair } = finding;
  const key = `${id} ${subject}`;
  const more = el(
    "details",
    { open: unfolded.has(key) },
    el("summary", {}, "Why, and how to repair it"),
    ...[...why, ...repair].map(paragraph),
  );
  more.addEventListener("toggle", () => unfolded[more.open ? "add" : "delete"](key));
  return el(
    "li",
    { class: "wv-finding", "data-level": level },
    el(
      "div",
      { class: "wv-finding-head" },
      el("span", { class: "wv-dot" }),
      el("b", {}, id),
      el("span", {}, cause),
    ),
    el("p", {}, remedy),
    command ? typed(command) : "",
    button ? remedyButton(button) : "",
    explains.length ? el("p", { class: "wv-quiet" }, `Explains ${explains.join(", ")}.`) : "",
    more,
  );
}

/**
 * A paragraph; an indented one is a command.
 *
 * @param {string} text
 */
const paragraph = (text) => (text.startsWith("    ") ? typed(text.trim()) : el("p", {}, text));

/** @param {string} command */
function typed(command) {
  const made = el("code", { class: "wv-finding-command" });
  setText(made, command);
  const take = async () =>
    toast((await copy(command)) ? "Copied." : "The browser does not allow it.");
  return el(
    "div",
    { class: "wv-finding-typed" },
    made,
    el(
      "button",
      {
        type: "button",
        class: "wv-icon",
        "aria-label": "Copy the command",
        "data-tip": "Copy",
        onclick: take,
      },
      icon("copy"),
    ),
  );
}
