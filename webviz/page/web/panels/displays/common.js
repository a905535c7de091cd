// Properties that several displays have in common, declared alike, and their values.

import { MIXED } from "../../controls/mixed.js";

const ALONE = new Set(["switches"]); // by names that each display has for itself

/** The properties that all of several lists have, as `content/forms.py` declares them. */
export function commonOf(lists) {
  const [first, ...others] = lists;
  return first.flatMap((property) => {
    const same = others.map((list) => list.find(({ path }) => path === property.path));
    if (ALONE.has(property.kind) || !same.every((one) => one && isAlike(one, property))) return [];
    const all = [property, ...same];
    if (property.kind === "topic" && new Set(all.map(({ type }) => type)).size > 1)
      return qosOf(all);
    if (!property.children) return withDefault(property, all);
    const children = commonOf(all.map((one) => one.children));
    return children.length ? [{ ...property, children }] : [];
  });
}

// Topics of other types have their QoS in common, and not their names.
function qosOf(all) {
  const children = commonOf(all.map((one) => one.children.slice(1)));
  return [{ ...all[0], kind: "group", label: "QoS", children }];
}

// Texts of help and defaults may differ.
function isAlike(one, other) {
  const about = ({ kind, label, unit, choices, items, low, above, high, below, when }) =>
    JSON.stringify([kind, label, unit, choices, items, low, above, high, below, when]);
  return about(one) === about(other);
}

function withDefault(property, all) {
  const defaults = new Set(all.map((one) => JSON.stringify(one.default)));
  if (defaults.size === 1) return [property];
  const { default: standard, ...rest } = property;
  return Array.isArray(standard) && property.kind === "vector" ? [] : [rest]; // its length is needed
}

/** The values of these properties by their keys in the stores; `MIXED` where they are not equal. */
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

const leavesOf = (declared) =>
  declared.flatMap((property) => (property.children ? leavesOf(property.children) : [property]));

function merged(values, isVector = false) {
  const [first, ...others] = values;
  if (others.every((value) => JSON.stringify(value) === JSON.stringify(first))) return first;
  return isVector ? first.map((_, index) => merged(values.map((value) => value[index]))) : MIXED;
}

/** A value for one display: where it is mixed, the display keeps its own. */
export const filled = (value, own) =>
  Array.isArray(value) ? value.map((each, index) => (each === MIXED ? own[index] : each)) : value;
