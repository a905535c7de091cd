// Properties that several displays have in common, declared alike, and their values.

import { MIXED } from "webviz/controls/mixed.js";

/** @import {DeclaredProperty} from "webviz/contents.js" */
/** @import {FormValues} from "webviz/types.js" */

const ALONE = new Set(["switches"]); // by names that each display has for itself

/**
 * The properties that all of several lists have, as `content/forms.py` declares them.
 *
 * @param {DeclaredProperty[][]} lists
 * @returns {DeclaredProperty[]}
 */
export function commonOf(lists) {
  const [first, ...others] = lists;
  return first.flatMap((property) => {
    const same = others
      .flatMap((list) => list.find(({ path }) => path === property.path) ?? [])
      .filter((one) => isAlike(one, property));
    if (ALONE.has(property.kind) || same.length < others.length) return [];
    const all = [property, ...same];
    if (property.kind === "topic" && new Set(all.map(({ type }) => type)).size > 1)
      return qosOf(all);
    if (!property.children) return withDefault(property, all);
    const children = commonOf(all.map((one) => one.children ?? []));
    return children.length ? [{ ...property, children }] : [];
  });
}

/**
 * Topics of other types have their QoS in common, and not their names.
 *
 * @param {DeclaredProperty[]} all
 * @returns {DeclaredProperty[]}
 */
function qosOf(all) {
  const children = commonOf(all.map((one) => (one.children ?? []).slice(1)));
  return [{ ...all[0], kind: "group", label: "QoS", children }];
}

/**
 * Texts of help and defaults may differ.
 *
 * @param {DeclaredProperty} one
 * @param {DeclaredProperty} other
 */
function isAlike(one, other) {
  /** @param {DeclaredProperty} property */
  const about = ({ kind, label, unit, choices, items, low, above, high, below, when }) =>
    JSON.stringify([kind, label, unit, choices, items, low, above, high, below, when]);
  return about(one) === about(other);
}

/**
 * @param {DeclaredProperty} property
 * @param {DeclaredProperty[]} all
 */
function withDefault(property, all) {
  const defaults = new Set(all.map((one) => JSON.stringify(one.default)));
  if (defaults.size === 1) return [property];
  const { default: standard, ...rest } = property;
  return Array.isArray(standard) && property.kind === "vector" ? [] : [rest]; // its length is needed
}

/**
 * The values of these properties by their keys in the stores; `MIXED` where they are not equal.
 *
 * @param {FormValues[]} stores
 * @param {DeclaredProperty[]} declared
 */
export function valuesOf(stores, declared) {
  return new Map(
    leavesOf(declared).map(({ path, kind }) => {
      const key = `value.${path}`;
      return [
        key,
        merged(
          stores.map((values) => values.get(key)),
          kind === "vector",
        ),
      ];
    }),
  );
}

/**
 * @param {DeclaredProperty[]} declared
 * @returns {DeclaredProperty[]}
 */
const leavesOf = (declared) =>
  declared.flatMap((property) => (property.children ? leavesOf(property.children) : [property]));

/**
 * @param {unknown[]} values
 * @param {boolean} [isVector]
 * @returns {unknown}
 */
function merged(values, isVector = false) {
  const [first, ...others] = values;
  if (others.every((value) => JSON.stringify(value) === JSON.stringify(first))) return first;
  if (!isVector) return MIXED;
  const vectors = /** @type {number[][]} */ (values);
  return vectors[0].map((_, index) => merged(vectors.map((vector) => vector[index])));
}

/**
 * A value for one display: where it is mixed, the display keeps its own.
 *
 * @param {unknown} value
 * @param {unknown} own
 */
export const filled = (value, own) =>
  Array.isArray(value) && Array.isArray(own)
    ? value.map((each, index) => (each === MIXED ? own[index] : each))
    : value;
