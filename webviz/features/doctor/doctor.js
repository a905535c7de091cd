// The panel "Doctor": the causes of what is not shown, the one to repair first on top.

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { copyAndTell } from "webviz/clipboard.js";
import { disclosure } from "webviz/controls/disclosure.js";
import { el } from "webviz/dom.js";
import { iconButton, textButton } from "webviz/icons.js";
import { timeOfDay } from "webviz/time_text.js";
import { openPanel } from "webviz/docks/layout.js";
import { computed, each, effect, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { GLOBAL } from "webviz/panels/displays/model.js";
import * as selection from "webviz/panels/displays/selection.js";
import { findingActs } from "webviz/panels/displays/statuses.js";
import { panel } from "webviz/panels/panels.js";
import { action } from "webviz/shell/actions.js";
import { displaysStart } from "webviz/panels/displays/displays.js";
import { explainStatuses, isSevere, keyOf } from "webviz/panels/findings.js";
import { findingsSections } from "webviz/panels/findings_sections.js";
import { headMark } from "webviz/shell/header.js";
import { badge } from "webviz/features/doctor/badge.js";
import { causes } from "webviz/features/doctor/causes.js";

/** @import {ShownFinding, ExplainedStatus} from "webviz/contents.js" */
/** @import {Readable} from "webviz/signals.js" */
/** @import {Panel} from "webviz/types.js" */

const WELL = "All is well: no check found a problem.";
const WELL_IN_TRIAL = "No check found a problem with the trial pose.";
const EXAMINING = "The doctor examines the viewer.";
const LISTED = 3; // displays that a finding names at once

const findings = store("findings");
/** The findings of the last round; read in effects. */
const all = () => findings.get("all") ?? [];
/** The key of the finding that a link leads to, once; "" for none. */
const target = signal("");

/** @type {Panel} */
const doctor = {
  name: "doctor",
  title: "Doctor",
  order: 60,
  isOnDemand: true,
  open(element) {
    const severe = computed(() => all().filter(isSevere));
    const notes = computed(() => all().filter((one) => !isSevere(one)));
    const at = () => findings.get("examined") ?? null;
    const sections = findingsSections.map((make) => make());
    const trial = () => sections.map((one) => one.trial?.() ?? "").find(Boolean) ?? "";
    const list = listOf("Findings", () => severe.value);
    const count = () => notes.value.length;
    const isUnfolded = signal(false);
    const isExamined = computed(() => at() !== null);
    element.append(
      el(
        "section",
        { class: "wv-doctor", "aria-label": "Doctor" },
        el("p", { class: "wv-doctor-trial", "data-level": "warn", hidden: () => !trial() }, trial),
        el(
          "p",
          { class: "wv-doctor-well", role: "status", hidden: () => severe.value.length > 0 },
          () => (isExamined.value ? (trial() ? WELL_IN_TRIAL : WELL) : EXAMINING),
        ),
        list,
        disclosure(
          el("span", {}, () => (count() === 1 ? "1 note" : `${count()} notes`)),
          () => listOf("Notes", () => notes.value),
          { class: "wv-doctor-notes", hidden: () => count() === 0 },
          isUnfolded,
        ),
        el(
          "p",
          { class: "wv-quiet wv-finding-examined", hidden: () => !isExamined.value },
          () => `As of ${clock(at() ?? 0)}.`,
        ),
        sections.flatMap(({ element: section }) => section ?? []),
      ),
    );
    effect(() => {
      const key = target.value;
      if (!all().length || !key) return;
      target.value = "";
      if (notes.value.some((one) => keyOf(one) === key)) isUnfolded.value = true;
      const items = /** @type {NodeListOf<HTMLElement>} */ (
        element.querySelectorAll(".wv-finding")
      );
      [...items].find((one) => one.dataset.finding === key)?.focus();
    });
    return () => {
      for (const { close } of sections) close?.();
    };
  },
};

export function install() {
  const open = () => openPanel("doctor");
  panel(doctor);
  action({ name: "Doctor", icon: "pulse", group: "View", run: open });
  explainStatuses({
    all,
    open(key) {
      target.value = key;
      open();
    },
  });
  displaysStart(() => causes(all, open));
  headMark(badge(all, open));
}

/**
 * @param {string} label
 * @param {() => ShownFinding[]} items
 */
const listOf = (label, items) =>
  el(
    "ol",
    { class: "wv-findings", "aria-label": label },
    each(items, keyOf, (finding, key) =>
      card(finding, key, () => {
        const [first, second] = items();
        return isSevere(first) && second !== undefined && keyOf(first) === key;
      }),
    ),
  );

/**
 * @param {Readable<ShownFinding>} finding
 * @param {string} key
 * @param {() => boolean} isFirst whether it is to be repaired before others
 */
function card(finding, key, isFirst) {
  const of = (/** @type {(one: ShownFinding) => unknown} */ read) =>
    computed(() => JSON.stringify(read(finding.value)));
  const began = of((one) => one.began);
  const explains = of((one) => one.explains);
  const text = (/** @type {"cause" | "proof" | "remedy"} */ name) => () => finding.value[name];
  return el(
    "li",
    {
      class: "wv-finding",
      "data-level": () => finding.value.level,
      "data-finding": key,
      tabindex: -1,
    },
    el("p", { class: "wv-quiet", hidden: () => !isFirst() }, "Fix this first:"),
    el("p", { class: "wv-finding-cause" }, text("cause")),
    el("p", { hidden: () => !finding.value.proof }, text("proof")),
    el("p", {}, text("remedy")),
    () => (finding.value.command ? typed(finding.value.command) : null),
    findingActs(
      finding,
      () => (began.value === "null" ? null : goTo(JSON.parse(began.value))),
      () => began.value !== "null",
    ),
    () => seenIn(JSON.parse(explains.value)),
    disclosure("Why, and how to repair it", () => reasons(finding)),
  );
}

/**
 * The documentation of a finding, what was measured, and the id by which others know it.
 *
 * @param {Readable<ShownFinding>} finding
 */
function reasons(finding) {
  const { id, why, repair } = finding.value;
  const facts = () => finding.value.evidence.map(([name, value]) => `${name} ${value}`);
  return [
    ...[...why, ...repair].map(paragraph),
    el(
      "p",
      { class: "wv-quiet", hidden: () => !facts().length },
      () => `Measured: ${facts().join("; ")}.`,
    ),
    el("p", { class: "wv-quiet" }, () => {
      const { since } = finding.value;
      return `Check ${id}${since === null ? "" : `, since ${clock(since)}`}.`;
    }),
  ];
}

/** @param {number} at in seconds since 1970 */
const clock = (at) => timeOfDay(at).split(" ").at(-1);

/**
 * The button that shows the moment at which a finding began.
 *
 * @param {readonly [number, number]} began in seconds since 1970, and from the start
 */
function goTo([at, position]) {
  const onclick = () => act("Seek", { at_s: position });
  return needs("Seek", textButton(`Go to ${clock(at)}`, onclick));
}

/**
 * Links to the displays whose statuses a finding explains; of many, the first ones and their number.
 *
 * @param {ExplainedStatus[]} explains
 */
function seenIn(explains) {
  const displays = new Map(explains.map((one) => [one.display, one]));
  if (!displays.size) return null;
  const some = [...displays.values()].slice(0, LISTED);
  const links = some.flatMap(({ display, status, name }, index) => {
    const link = textButton(name || status, () => show(display), { class: "wv-link" });
    return index ? [", ", link] : [link];
  });
  const more = displays.size - some.length;
  return el("p", { class: "wv-quiet" }, "Seen in ", links, more ? ` and ${more} more.` : ".");
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
  return el(
    "div",
    { class: "wv-finding-typed" },
    el("code", { class: "wv-finding-command" }, command),
    iconButton("copy", "Copy the command", () => copyAndTell(command), { tip: "Copy" }),
  );
}
