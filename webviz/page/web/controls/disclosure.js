// A line that unfolds what is below it.

import { el, newId } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { effect, signal } from "webviz/signals.js";

/** @import {Signal} from "webviz/signals.js" */
/** @import {Child} from "webviz/types.js" */

/**
 * A button, and below it what it unfolds; `content` is called when that is first shown.
 *
 * @param {Child} label
 * @param {() => Child | Child[]} content
 * @param {{class?: string, hidden?: () => boolean}} [attributes] of the element around both
 * @param {Signal<boolean>} [isOpen]
 */
export function disclosure(label, content, attributes = {}, isOpen = signal(false)) {
  const id = newId("disclosure");
  const wasOpen = signal(false);
  effect(() => {
    if (isOpen.value) wasOpen.value = true;
  });
  const button = el(
    "button",
    {
      type: "button",
      class: "wv-section-fold wv-disclosure",
      "aria-controls": id,
      "aria-expanded": () => String(isOpen.value),
      onclick: () => (isOpen.value = !isOpen.value),
    },
    icon("chevron", 12),
    label,
  );
  const region = el("div", { id, hidden: () => !isOpen.value }, () =>
    wasOpen.value ? content() : null,
  );
  return el("div", attributes, button, region);
}
