// Stores of this page by itself, under viser's id of it, which is another one when it connects again.

import * as channel from "./channel.js";
import { signal } from "./signals.js";
import { store } from "./stores.js";

/** @import {Named, StoreReader} from "./types.js" */

const browser = signal(/** @type {number | null} */ (null));
channel.onOpen(() => (browser.value = window.webviz.browser));

/**
 * A store of this page to read from in effects; see `store`.
 *
 * @template {"view" | "view_type"} N
 * @param {N} name
 * @returns {Pick<StoreReader<Named<N>>, "get">}
 */
export const ownStore = (name) => ({
  get: (/** @type {string} */ key) =>
    browser.value === null ? undefined : store(`${name}:${browser.value}`).get(key),
});
