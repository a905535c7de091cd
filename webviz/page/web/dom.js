// Elements. Text is always text, never markup.

import { counter } from "webviz/numbers.js";
import { effect, Source } from "webviz/signals.js";

/** @import {Attribute, Child, Children} from "webviz/types.js" */

const SVG = "http://www.w3.org/2000/svg";
const nextId = counter();

/**
 * An id that no other element has.
 *
 * @param {string} name
 */
export const newId = (name) => `wv-${name}-${nextId()}`;

/**
 * An element with attributes and children: strings and elements, null for none.
 *
 * An attribute that is a function is a listener if its name is that of one (`onclick`); true is an
 * attribute without a value; false, null and undefined are none. ARIA's attributes say "true" and
 * "false" in words. Signals, and other functions, are read in an effect: an attribute or a child that
 * follows what it reads, see `signals.js`.
 *
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, Attribute>} [attributes]
 * @param {...Children} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function el(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  set(element, attributes);
  append(element, children);
  return element;
}

/**
 * Changes attributes of an element, as `el` reads them.
 *
 * @param {Element} element
 * @param {Record<string, Attribute>} attributes
 */
export function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function" && name.startsWith("on")) {
      element.addEventListener(name.slice(2), value);
    } else if (typeof value === "function") {
      const read = /** @type {() => Attribute} */ (value);
      effect(() => set(element, { [name]: read() }));
    } else if (value instanceof Source) effect(() => set(element, { [name]: value.value }));
    else if (typeof value === "boolean" && !name.startsWith("aria-")) {
      element.toggleAttribute(name, value);
    } else if (value === null || value === undefined) element.removeAttribute(name);
    else if (element.getAttribute(name) !== String(value))
      element.setAttribute(name, String(value));
  }
}

/**
 * @param {Element} parent
 * @param {Children[]} children
 */
function append(parent, children) {
  for (const child of children.flat()) {
    if (typeof child === "function") follow(parent, child);
    else if (child instanceof Source) follow(parent, () => child.value);
    else if (child !== null && child !== undefined) parent.append(child);
  }
}

/**
 * Keeps what is read in its place among the children of an element. A text is that of one node, so it
 * is changed without a new one.
 *
 * @param {Element} parent
 * @param {() => Child | Child[]} read
 */
function follow(parent, read) {
  const end = new Text();
  parent.append(end);
  /** @type {ChildNode[]} */
  let current = [];
  effect(() => {
    const children = [read()].flat().filter((child) => child !== null && child !== undefined);
    const isText = children.length === 1 && typeof children[0] === "string";
    const text = isText ? String(children[0]) : "";
    if (end.data !== text) end.data = text;
    const next = isText
      ? []
      : children.map(
          (child) => /** @type {ChildNode} */ (child instanceof Node ? child : new Text(child)),
        );
    if (end.parentNode) arrange(end.parentNode, current, next, end);
    current = next;
  });
}

/**
 * Puts nodes in order into an element, in place of others, before `end`. What has the focus is never
 * moved, and nothing changes if they are in order.
 *
 * @param {Node} parent
 * @param {ChildNode[]} before
 * @param {ChildNode[]} next
 * @param {ChildNode} [end]
 */
function arrange(parent, before, next, end) {
  const nextNodes = new Set(next);
  for (const node of before) if (!nextNodes.has(node)) node.remove();
  const all = end ? [...next, end] : next;
  if (!all.length) return;
  const focused = document.activeElement;
  const fixed = parent.contains(focused) ? all.findIndex((node) => node.contains(focused)) : -1;
  const start = fixed < 0 ? all.length - 1 : fixed;
  if (all[start].parentNode !== parent) parent.appendChild(all[start]);
  for (let i = start - 1; i >= 0; i--) {
    if (all[i].nextSibling !== all[i + 1]) all[i + 1].before(all[i]);
  }
  for (let i = start + 1; i < all.length; i++) {
    if (all[i].previousSibling !== all[i - 1]) all[i - 1].after(all[i]);
  }
}

/**
 * The 2D context of a canvas, which has no other.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {CanvasRenderingContext2DSettings} [settings]
 */
export const contextOf = (canvas, settings) =>
  /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", settings));

/**
 * Changes the text of an element, if it is another one.
 *
 * @param {Element} element
 * @param {string} text
 */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/**
 * Shows a text in an element, which is hidden without one.
 *
 * @param {Element} element
 * @param {string} text
 */
export function showText(element, text) {
  setText(element, text);
  set(element, { hidden: !text });
}

/**
 * Puts these children into an element, in this order, in place of others.
 *
 * @param {Element} element
 * @param {Element[]} children
 */
export const setChildren = (element, children) => arrange(element, [...element.children], children);

/**
 * An element of a drawing, with attributes and children as for `el`.
 *
 * @template {keyof SVGElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, Attribute>} [attributes]
 * @param {...(Node | string)} children
 * @returns {SVGElementTagNameMap[K]}
 */
export function svgElement(tag, attributes = {}, ...children) {
  const element = document.createElementNS(SVG, tag);
  set(element, attributes);
  element.append(...children);
  return element;
}

/**
 * An icon of 24 x 24 units, drawn by lines; see `icons.js`.
 *
 * @param {string} path
 * @param {number} [size]
 */
export function svg(path, size = 16) {
  return svgElement(
    "svg",
    {
      viewBox: "0 0 24 24",
      width: size,
      height: size,
      fill: "none",
      stroke: "currentColor",
      "stroke-width": 1.8,
      "stroke-linecap": "round",
      "stroke-linejoin": "round",
      "aria-hidden": "true",
    },
    svgElement("path", { d: path }),
  );
}
