// Stores of this page alone, under viser's id of it, which is another one when it connects again.

import * as channel from "webviz/channel.js";
import { signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";

/** @import {Named, StoreReader, ValuesOf} from "webviz/types.js" */

const browser = signal(/** @type {number | null} */ (null));
channel.onOpen(() => (browser.value = window.webviz.browser));

/**
 * A store of this page to read from in effects; see `store`.
 *
 * @template {"selected" | "selection" | "view" | "view_type"} N
 * @param {N} name
 * @returns {Pick<StoreReader<Named<N>>, "get"> & {all(): ValuesOf<N> | undefined}}
 */
export function ownStore(name) {
  const own = () => {
    const named = browser.value === null ? null : store(`${name}:${browser.value}`);
    return /** @type {StoreReader<Named<N>> | null} */ (/** @type {unknown} */ (named));
  };
  return {
    get: (/** @type {any} */ key) => own()?.get(key),
    all: () => own()?.all(),
  };
}
