// The causes behind the statuses of several displays, each said once above the list of displays.

import { el } from "webviz/dom.js";
import { textButton } from "webviz/icons.js";
import { computed, each } from "webviz/signals.js";
import { findingActs } from "webviz/panels/displays/statuses.js";
import { findingLink, isShared, keyOf } from "webviz/panels/findings.js";

/** @import {ShownFinding} from "webviz/contents.js" */
/** @import {Readable} from "webviz/signals.js" */

const LISTED = 2; // the doctor has the others

/**
 * @param {() => readonly ShownFinding[]} findings read in effects
 * @param {() => unknown} open shows all of them
 */
export function causes(findings, open) {
  const shared = () => findings().filter(isShared);
  const more = () => shared().length - LISTED;
  const text = () => (more() === 1 ? "1 more cause" : `${more()} more causes`);
  const others = textButton("", open, { class: "wv-link" });
  others.append(el("span", {}, text));
  return el(
    "div",
    { class: "wv-causes", role: "status", hidden: () => !shared().length },
    each(() => shared().slice(0, LISTED), keyOf, card),
    el("div", { hidden: () => more() <= 0 }, others),
  );
}

/** @param {Readable<ShownFinding>} finding */
function card(finding) {
  const cause = computed(() => finding.value.cause);
  return el(
    "div",
    { class: "wv-finding", "data-level": () => finding.value.level },
    el("p", { class: "wv-finding-cause" }, cause),
    el("p", { hidden: () => !finding.value.proof }, () => finding.value.proof),
    findingActs(finding, () => cause.value && findingLink(finding.value)),
  );
}
