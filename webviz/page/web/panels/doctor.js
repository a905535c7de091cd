// The panel "Doctor": the causes of what is not shown, the one to repair first on top.

import { needs } from "../access.js";
import { act } from "../act.js";
import { copyAndTell } from "../clipboard.js";
import { el, set, setText } from "../dom.js";
import { iconButton, textButton } from "../icons.js";
import { timeOfDay } from "../time_text.js";
import { openPanel } from "../docks/layout.js";
import { watch } from "../stores.js";
import { GLOBAL } from "./displays/model.js";
import * as selection from "./displays/selection.js";
import { remedyButton } from "./displays/statuses.js";
import { doctorSections } from "./doctor_sections.js";
import { isSevere, keyOf, takeWanted } from "./findings.js";

const WELL = "All is well: no check found a problem.";
const EXAMINING = "The doctor examines the viewer.";

/** @import {ShownFinding, ExplainedStatus} from "../contents.js" */

export const doctor = {
  name: "doctor",
  title: "Doctor",
  order: 60,
  isOnDemand: true,
  /** @param {HTMLElement} element */
  open(element) {
    const list = el("ol", { class: "wv-findings", "aria-label": "Findings" });
    const empty = el("p", { class: "wv-empty", role: "status" }, EXAMINING);
    const examined = el("p", { class: "wv-quiet wv-finding-examined" });
    const sections = doctorSections.map((make) => make());
    element.append(
      el(
        "section",
        { class: "wv-doctor", "aria-label": "Doctor" },
        empty,
        examined,
        list,
        sections.map(({ element: section }) => section),
      ),
    );
    /** @type {Set<string>} */
    const unfolded = new Set();
    let shown = "";

    const end = watch("findings", (values) => {
      const all = values.get("all") ?? [];
      const at = values.get("examined") ?? null;
      set(empty, { hidden: all.length > 0 });
      setText(empty, at === null ? EXAMINING : WELL);
      set(examined, { hidden: at === null });
      setText(examined, at === null ? "" : `As of ${clock(at)}.`);
      if (JSON.stringify(all) === shown) return;
      shown = JSON.stringify(all);
      const isFirst = all.filter(isSevere).length > 1;
      list.replaceChildren(...all.map((one, i) => item(one, unfolded, isFirst && i === 0)));
      const key = takeWanted();
      const led = [...list.children].find((each) => each.getAttribute("data-finding") === key);
      if (led instanceof HTMLElement) led.focus();
    });
    return () => {
      end();
      for (const { close } of sections) close();
    };
  },
};

/**
 * @param {ShownFinding} finding
 * @param {Set<string>} unfolded
 * @param {boolean} isFirst whether it is to be repaired before others
 */
function item(finding, unfolded, isFirst) {
  const { id, level, cause, since, evidence, began, remedy, command } = finding;
  const { explains, button, why, repair } = finding;
  const key = keyOf(finding);
  const more = el(
    "details",
    { open: unfolded.has(key) },
    el("summary", {}, "Why, and how to repair it"),
    ...[...why, ...repair].map(paragraph),
  );
  more.addEventListener("toggle", () => unfolded[more.open ? "add" : "delete"](key));
  return el(
    "li",
    { class: "wv-finding", "data-level": level, "data-finding": key, tabindex: -1 },
    isFirst ? el("p", { class: "wv-quiet" }, "Fix this first:") : "",
    el(
      "div",
      { class: "wv-finding-head" },
      el("span", { class: "wv-dot" }),
      el("b", {}, id),
      el("span", {}, cause),
    ),
    el("p", {}, remedy),
    command ? typed(command) : "",
    button || began
      ? el(
          "div",
          { class: "wv-finding-acts" },
          button ? remedyButton(button) : "",
          began ? goTo(began) : "",
        )
      : "",
    since || evidence.length ? el("p", { class: "wv-quiet" }, seen(since, evidence)) : "",
    explains.length
      ? el("p", { class: "wv-quiet" }, "Explains ", ...explains.flatMap(explained), ".")
      : "",
    more,
  );
}

/** @param {number} at in seconds since 1970 */
const clock = (at) => timeOfDay(at).split(" ").at(-1);

/**
 * @param {number | null} since when it was first seen
 * @param {ReadonlyArray<readonly [string, string]>} evidence
 */
function seen(since, evidence) {
  const time = since === null ? "" : `Since ${clock(since)}. `;
  return time + (evidence.length ? `Evidence: ${evidence.map(fact).join("; ")}.` : "");
}

/** @param {readonly [string, string]} evidence a name and a value */
const fact = ([name, value]) => `${name} ${value}`;

/**
 * The button that shows the moment at which a finding began.
 *
 * @param {readonly [number, number]} began in seconds since 1970, and from the start
 */
function goTo([at, position]) {
  const text = `Go to ${clock(at)}`;
  const onclick = () => act("Seek", { at_s: position });
  return needs("Seek", textButton(text, onclick));
}

/**
 * A status that a finding explains, with a link to its display.
 *
 * @param {ExplainedStatus} status
 * @param {number} index
 */
function explained({ display, status, name }, index) {
  const link = el("button", { type: "button", class: "wv-link", onclick: () => show(display) });
  setText(link, name ? `${name}: ${status}` : status);
  return index ? [", ", link] : [link];
}

/** @param {string} display */
function show(display) {
  openPanel("displays");
  selection.reveal(display || GLOBAL);
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
  return el(
    "div",
    { class: "wv-finding-typed" },
    made,
    iconButton("copy", "Copy the command", () => copyAndTell(command), { tip: "Copy" }),
  );
}
