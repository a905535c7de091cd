// Findings, which explain statuses, and the way to them; a feature has them.

import { textButton } from "webviz/icons.js";
import { signal } from "webviz/signals.js";

/** @import {ShownFinding} from "webviz/contents.js" */

/**
 * `all` is read in effects; `open` shows the finding of a key.
 *
 * @typedef {{all(): readonly ShownFinding[], open(key: string): unknown}} Finder
 */

const finder = signal(/** @type {Finder | null} */ (null));

/** @param {Finder} find */
export const explainStatuses = (find) => (finder.value = find);

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

/**
 * The finding to repair first of those that explain a status, or any status of the display without
 * one; read in effects. The viewer as a whole is the display "".
 *
 * @param {string} display
 * @param {string} [status]
 */
export const explaining = (display, status) =>
  finder.value
    ?.all()
    .find(({ explains }) =>
      explains.some(
        (one) => one.display === display && (status === undefined || one.status === status),
      ),
    );

/**
 * A link that opens a finding.
 *
 * @param {ShownFinding} finding
 */
export const findingLink = (finding) =>
  textButton("Why?", () => finder.value?.open(keyOf(finding)), {
    class: "wv-link wv-finding-link",
    "aria-label": `Why? ${finding.cause}`,
    "data-finding": keyOf(finding),
  });
