// The number of findings in the head of the side, while there are any.

import { el } from "webviz/dom.js";
import { isSevere } from "webviz/panels/findings.js";

/** @import {ShownFinding} from "webviz/contents.js" */

/**
 * @param {() => readonly ShownFinding[]} findings read in effects
 * @param {() => unknown} open shows them
 */
export function badge(findings, open) {
  const severe = () => findings().filter(isSevere);
  const count = () => String(severe().length);
  const cause = () => severe()[0]?.cause;
  return el(
    "button",
    {
      type: "button",
      class: "wv-icon wv-doctor-badge",
      hidden: () => !severe().length,
      "data-level": () => severe()[0]?.level,
      "aria-label": () => `Doctor: ${count() === "1" ? "1 finding" : `${count()} findings`}`,
      "aria-description": cause,
      "data-tip": cause,
      onclick: open,
    },
    el("span", { class: "wv-dot", "aria-hidden": "true" }),
    el("span", {}, count),
  );
}
