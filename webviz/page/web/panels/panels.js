// The panels in the order of their tabs.
//
// Each has a `name`, a `title`, an `order` among the others, and `open(element)`, which fills the tab when it is shown and returns
// what is to be done when it is not any more. The tab of one that `isOnDemand` is there while it is
// open only.

import { displays } from "webviz/panels/displays/displays.js";
import { computed, signal, untracked } from "webviz/signals.js";

/** @import {PanelType} from "webviz/contents.js" */
/** @import {Signal} from "webviz/signals.js" */
/** @import {Panel} from "webviz/types.js" */

const LAST = 1000;

const own = signal([displays]);
/** Panels that people add and remove, behind the others. @type {Signal<Panel[]>} */
export const added = signal([]);
/** The types of these. @type {Signal<PanelType[]>} */
export const types = signal([]);
export const panels = computed(() => [...own.value, ...added.value]);

/**
 * Adds a panel, or replaces that of the same name.
 *
 * @param {Panel} added
 */
export function panel(added) {
  const before = untracked(() => own.value);
  const isKnown = before.some(({ name }) => name === added.name);
  const all = isKnown
    ? before.map((each) => (each.name === added.name ? added : each))
    : [...before, added];
  own.value = all.sort((a, b) => (a.order ?? LAST) - (b.order ?? LAST));
}
