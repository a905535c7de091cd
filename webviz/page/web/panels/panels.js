// The panels in the order of their tabs.
//
// Each has a `name`, a `title`, an `order` among the others, and `open(element)`, which fills the tab when it is shown and returns
// what is to be done when it is not any more. The tab of one that `isOnDemand` is there while it is
// open only.

import { listeners } from "webviz/listeners.js";
import { displays } from "webviz/panels/displays/displays.js";

/** @import {Panel} from "webviz/types.js" */

const LAST = 1000;

/** @type {Panel[]} */
export const panels = [];
const changes = listeners();

/**
 * Adds a panel, or replaces that of the same name.
 *
 * @param {Panel} added
 */
export function panel(added) {
  const index = panels.findIndex(({ name }) => name === added.name);
  if (index < 0) panels.push(added);
  else panels[index] = added;
  panels.sort((a, b) => (a.order ?? LAST) - (b.order ?? LAST));
  changes.tell();
}

/** Calls a listener whenever there is another panel. */
export const onPanel = changes.on;

panel(displays);
