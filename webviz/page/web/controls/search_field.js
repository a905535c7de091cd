// A field to search or filter a list.

import { el } from "../dom.js";

/** @import {Attribute} from "../types.js" */

/**
 * @param {string} label which is its placeholder, too, unless that is among the attributes
 * @param {() => unknown} oninput
 * @param {Record<string, Attribute>} [attributes]
 */
export const searchField = (label, oninput, attributes = {}) =>
  el("input", {
    class: "wv-field",
    type: "search",
    placeholder: label,
    "aria-label": label,
    oninput,
    ...attributes,
  });
