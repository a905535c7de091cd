// Findings of the doctor: what explains a status, and the way to them.

import { textButton } from "../icons.js";
import { openPanel } from "../docks/layout.js";
import { store } from "../stores.js";

/** @import {ShownFinding} from "../contents.js" */

const findings = store("findings");
let wanted = "";

/**
 * Returns true if a finding is more than a note.
 *
 * @param {ShownFinding} finding
 */
export const isSevere = ({ level }) => level !== "ok";

/**
 * The id and subject of a finding, by which it is known again.
 *
 * @param {ShownFinding} finding
 */
export const keyOf = ({ id, subject }) => `${id} ${subject}`;

/** The displays whose statuses a finding explains, the viewer as a whole being "". @param {ShownFinding} finding */
const displaysOf = ({ explains }) => new Set(explains.map(({ display }) => display));

/**
 * Returns true if a finding is behind statuses of several displays, or of the viewer: it is said once
 * for all of them.
 *
 * @param {ShownFinding} finding
 */
export const isShared = (finding) =>
  isSevere(finding) && (displaysOf(finding).size > 1 || displaysOf(finding).has(""));

/** The findings that are said once for several displays; read in effects. */
export const shared = () => (findings.get("all") ?? []).filter(isShared);

/**
 * The finding to repair first of those that explain a status, or any status of the display without
 * one; read in effects. The viewer as a whole is the display "".
 *
 * @param {string} display
 * @param {string} [status]
 */
export const explaining = (display, status) =>
  findings
    .get("all")
    ?.find(({ explains }) =>
      explains.some(
        (one) => one.display === display && (status === undefined || one.status === status),
      ),
    );

/**
 * A link that opens the doctor at a finding.
 *
 * @param {ShownFinding} finding
 */
export function findingLink(finding) {
  const open = () => {
    wanted = keyOf(finding);
    openPanel("doctor");
  };
  return textButton("Why?", open, {
    class: "wv-link wv-finding-link",
    "aria-label": `Why? ${finding.cause}`,
    "data-finding": keyOf(finding),
  });
}

/** The key of the finding that a link has led to, once; "" for none. */
export function takeWanted() {
  const key = wanted;
  wanted = "";
  return key;
}
