// Fields to type a text in, and to search or filter a list.

import { el } from "webviz/dom.js";

/** @import {Attribute} from "webviz/types.js" */

/**
 * @param {string} label
 * @param {Record<string, Attribute>} [attributes]
 */
export const textField = (label, attributes = {}) =>
  el("input", { class: "wv-field", type: "text", "aria-label": label, ...attributes });

/**
 * @param {string} label which is its placeholder, too, unless that is among the attributes
 * @param {() => unknown} oninput
 * @param {Record<string, Attribute>} [attributes]
 */
export const searchField = (label, oninput, attributes = {}) =>
  textField(label, { type: "search", placeholder: label, oninput, ...attributes });
