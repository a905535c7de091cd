// Statuses of a display, or of the viewer: a line each, folded to the worst.

import { needs } from "../../access.js";
import { act } from "../../act.js";
import { el, set, setChildren, setText } from "../../dom.js";
import { icon, textButton } from "../../icons.js";
import { findingLink, keyOf, onFindings } from "../findings.js";

/** @import {Commands} from "../../messages.js" */
/** @import {Explaining} from "../findings.js" */
/** @import {RemedyButton, ShownFinding, StatusLine, WorstStatus} from "../../contents.js" */

/** @typedef {(lines: StatusLine[], more: number) => void} ShowLines */

let count = 0;

/**
 * Sends a command that a remedy names.
 *
 * @param {string} command
 * @param {RemedyButton["arguments"]} fields
 */
const run = (command, fields) =>
  act(
    /** @type {keyof Commands} */ (command),
    /** @type {Commands[keyof Commands]} */ (/** @type {object} */ (fields)),
  );

/**
 * A button that does what helps.
 *
 * @param {RemedyButton} remedy
 */
export const remedyButton = ({ label, command, arguments: fields }) =>
  needs(
    command,
    textButton(label, () => run(command, fields), { class: "wv-button wv-remedy" }),
  );

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
 * `open(listener)` is called while they are unfolded, and returns what ends that; the listener gets
 * `lines`: `[key, level, text, remedy]`, and how many `more` there are; a remedy is
 * `{label, command, arguments}`, what a click can do about it. `display` is the id of the display, ""
 * for the viewer; statuses that a finding explains have a link to it. Returns `{element, worst(line), end()}`.
 *
 * @param {{open: (listener: ShowLines) => () => void, display: string}} options
 */
export function statuses({ open, display }) {
  count += 1;
  const list = el("ul", { class: "wv-statuses-lines", id: `wv-statuses-${count}` });
  const note = el("span", { class: "wv-status-note" });
  const toggle = el(
    "button",
    {
      type: "button",
      class: "wv-section-fold wv-status-head",
      "aria-controls": list.id,
      onclick: () => {
        chosen = list.hidden === true;
        unfold();
      },
    },
    icon("chevron", 12),
    "Status",
    el("span", { class: "wv-dot", "aria-hidden": "true" }),
    note,
  );
  const element = el("section", { class: "wv-statuses", "aria-label": "Status" }, toggle, list);
  /** @type {boolean | null} */
  let chosen = null;
  let level = "ok";
  /** @type {(() => void) | null} */
  let close = null;

  function unfold() {
    const isOpen = chosen ?? level !== "ok";
    if (isOpen === Boolean(close)) return;
    list.hidden = !isOpen;
    set(toggle, { "aria-expanded": String(isOpen) });
    close?.();
    close = isOpen ? opened() : null;
  }

  function opened() {
    /** @type {[StatusLine[], number]} */
    let said = [[], 0];
    /** @type {Explaining} */
    let explaining = () => undefined;
    const update = () => show(...said, explaining);
    const ends = [
      open((lines, more) => {
        said = [lines, more];
        update();
      }),
      onFindings((each) => {
        explaining = each;
        update();
      }),
    ];
    return () => ends.forEach((end) => end());
  }

  /**
   * @param {StatusLine[]} lines
   * @param {number} more
   * @param {Explaining} explaining
   */
  function show(lines, more, explaining) {
    const items = lines.map((line, index) =>
      fill(list.children[index] ?? item(), line, explaining),
    );
    const rest = more ? [el("li", { class: "wv-quiet" }, `and ${more} more`)] : [];
    setChildren(list, [...items, ...rest]);
  }

  /**
   * @param {Element} element
   * @param {StatusLine} line
   * @param {Explaining} explaining
   */
  function fill(element, [key, own, text, remedy], explaining) {
    const [name, said, helps] = element.children;
    const finding = own === "ok" || own === "idle" ? undefined : explaining(display, key);
    set(element, { "data-level": own });
    setText(name, `${key}: `);
    setText(said, text);
    fillHelp(/** @type {HTMLElement} */ (helps), remedy, finding);
    return element;
  }

  const item = () => el("li", {}, el("b"), el("span"), el("span"));

  set(toggle, { "aria-expanded": "false" });
  list.hidden = true;
  return {
    element,
    /**
     * The worst line, null for none; it decides what is folded.
     *
     * @param {WorstStatus | null | undefined} line
     */
    worst(line) {
      element.hidden = !line;
      level = line?.level ?? "ok";
      set(toggle, { "data-level": level });
      setText(note, line && level !== "ok" ? `${line.key}: ${line.text}` : "OK");
      unfold();
    },
    end: () => close?.(),
  };
}
