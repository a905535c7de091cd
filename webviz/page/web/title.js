// The title of the tab: the config, and before it what must not be overlooked.

import { effect, signal } from "webviz/signals.js";

const name = signal(document.title);
const prefix = signal("");

effect(() => {
  document.title = prefix.value + name.value;
});

/**
 * Names what the page shows.
 *
 * @param {string} next
 */
export const setTitle = (next) => void (name.value = next);

/**
 * Puts a text before the name, "" for none.
 *
 * @param {string} next
 */
export const setTitlePrefix = (next) => void (prefix.value = next);
