// Statuses of a display, or of the viewer: a line each, folded to the worst.

import { needs } from "webviz/access.js";
import { act, newStep } from "webviz/act.js";
import { el, newId, set } from "webviz/dom.js";
import { icon, textButton } from "webviz/icons.js";
import { computed, each, effect, signal } from "webviz/signals.js";
import { explaining, findingLink, keyOf } from "webviz/panels/findings.js";

/** @import {Commands} from "webviz/messages.js" */
/** @import {RemedyButton, ShownFinding, StatusLine, WorstStatus} from "webviz/contents.js" */
/** @import {Readable} from "webviz/signals.js" */
/** @import {Child} from "webviz/types.js" */

/**
 * Sends a command that a remedy names with each of its arguments, as one step to undo.
 *
 * @param {RemedyButton} remedy
 */
function run({ command, arguments: all }) {
  const step = all.length > 1 ? newStep() : 0;
  for (const fields of all)
    act(
      /** @type {keyof Commands} */ (command),
      /** @type {Commands[keyof Commands]} */ (/** @type {object} */ (fields)),
      { step },
    );
}

/**
 * A button that does what helps.
 *
 * @param {RemedyButton} remedy
 */
const remedyButton = (remedy) =>
  needs(
    remedy.command,
    textButton(remedy.label, () => run(remedy), { class: "wv-button wv-remedy" }),
  );

/**
 * The row of buttons of a finding: what a click can do about it, and another one. It is hidden while
 * there is none.
 *
 * @param {Readable<ShownFinding>} finding
 * @param {() => Child} other
 * @param {() => boolean} hasOther
 */
export function findingActs(finding, other, hasOther = () => true) {
  const remedy = computed(() => JSON.stringify(finding.value.button));
  const hidden = () => remedy.value === "null" && !hasOther();
  const button = () => (remedy.value === "null" ? null : remedyButton(JSON.parse(remedy.value)));
  return el("div", { class: "wv-finding-acts", hidden }, button, other);
}

/**
 * Fills an element with the button of a remedy and the link to the finding that explains a status, if
 * there are any; it is hidden without.
 *
 * @param {HTMLElement} element
 * @param {RemedyButton | null | undefined} remedy
 * @param {ShownFinding | undefined} finding
 */
export function fillHelp(element, remedy, finding) {
  const key = JSON.stringify([remedy, finding && [keyOf(finding), finding.cause]]);
  if (element.dataset.help === key) return;
  set(element, { "data-help": key, hidden: !remedy && !finding });
  element.replaceChildren(
    ...(remedy ? [remedyButton(remedy)] : []),
    ...(finding ? [findingLink(finding)] : []),
  );
}

/**
 * Statuses that are folded while all is well, until they are unfolded by hand.
 *
 * All are read in effects: `worst()` decides what is folded, and nothing is shown without; `lines()`,
 * read while they are unfolded, are `[key, level, text, remedy]`, with how many `more()` there are; a
 * remedy is `{label, command, arguments}`, what a click can do about it. `display` is the id of the
 * display, "" for the viewer; statuses that a finding explains have a link to it.
 *
 * @param {{
 *   display: string, worst: () => WorstStatus | null | undefined, lines: () => StatusLine[],
 *   more: () => number,
 * }} options
 */
export function statuses({ display, worst, lines, more }) {
  const id = newId("statuses");
  const chosen = signal(/** @type {boolean | null} */ (null));
  const level = () => worst()?.level ?? "ok";
  const isOpen = computed(() => chosen.value ?? level() !== "ok");
  const toggle = el(
    "button",
    {
      type: "button",
      class: "wv-section-fold wv-status-head",
      "aria-controls": id,
      "aria-expanded": () => String(isOpen.value),
      "data-level": level,
      onclick: () => (chosen.value = !isOpen.value),
    },
    icon("chevron", 12),
    "Status",
    el("span", { class: "wv-dot", "aria-hidden": "true" }),
    el("span", { class: "wv-status-note" }, () => {
      const line = worst();
      return line && level() !== "ok" ? `${line.key}: ${line.text}` : "OK";
    }),
  );
  const list = el(
    "ul",
    { class: "wv-statuses-lines", id, hidden: () => !isOpen.value },
    each(
      () => (isOpen.value ? lines().entries() : []),
      ([index]) => index,
      (item) => lineOf(display, () => item.value[1]),
    ),
    () => (isOpen.value && more() ? el("li", { class: "wv-quiet" }, `and ${more()} more`) : null),
  );
  const attributes = { class: "wv-statuses", "aria-label": "Status", hidden: () => !worst() };
  return el("section", attributes, toggle, list);
}

/**
 * @param {string} display
 * @param {() => StatusLine} line
 */
function lineOf(display, line) {
  const help = el("span");
  effect(() => {
    const [key, level, , remedy] = line();
    const isFault = level !== "ok" && level !== "idle";
    fillHelp(help, remedy, isFault ? explaining(display, key) : undefined);
  });
  return el(
    "li",
    { "data-level": () => line()[1] },
    el("b", {}, () => `${line()[0]}: `),
    el("span", {}, () => line()[2]),
    help,
  );
}
