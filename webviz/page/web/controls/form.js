// The properties of something, one below the other, with those that belong together in sections.

import { el, set } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { recall, remember } from "webviz/remember.js";
import { computed, signal, untracked } from "webviz/signals.js";
import { row } from "webviz/controls/property_row.js";

/** @import {DeclaredProperty} from "webviz/contents.js" */
/** @import {Child, FormValues, SendProperty} from "webviz/types.js" */

/**
 * The values of a form, and how they are sent.
 *
 * @typedef {{
 *   values: FormValues, send: SendProperty, name: string, marks: boolean, command: string,
 * }} Options
 */

/**
 * For `el`: the form of what these values say is "declared", made anew when that is something else.
 *
 * @param {FormValues} values
 * @param {(declared: DeclaredProperty[]) => HTMLElement} make
 * @returns {() => HTMLElement}
 */
export function declaredForm(values, make) {
  const declared = computed(() => JSON.stringify(values.get("declared") ?? []));
  return () => {
    const properties = JSON.parse(declared.value);
    return untracked(() => make(properties));
  };
}

/**
 * Rows for properties as `content/forms.py` declares them.
 *
 * `send(path, value)` sends what was entered and returns the promise of `act`. `name` is
 * what this browser remembers by which sections are folded. `marks`: whether what differs from the
 * default is marked. `command`: of the viewer, that `send` uses, if a role may not be allowed it.
 *
 * @param {DeclaredProperty[]} declared
 * @param {Omit<Options, "marks" | "command"> & Partial<Options>} options
 */
export function form(declared, { marks = true, command = "", ...rest }) {
  const options = { marks, command, ...rest };
  const parts = declared.map((property) => part(property, options, 0));
  return el("div", { class: "wv-form" }, parts);
}

/**
 * @param {DeclaredProperty} property
 * @param {Options} options
 * @param {number} depth
 * @returns {HTMLElement}
 */
function part(property, options, depth) {
  const { kind, when, path, otherwise } = property;
  const { values } = options;
  const element =
    kind === "topic"
      ? topic(property, options, depth)
      : kind === "group"
        ? section(property, options, depth)
        : rowOf(property, options, {
            live: () => values.get(`offered.${path}`),
            otherwise: () => (otherwise ? values.get(`value.${otherwise}`) : undefined),
          });
  element.style.setProperty("--wv-depth", String(depth));
  if (when) {
    const isShown = () => when.every(([other, all]) => all.includes(values.get(`value.${other}`)));
    set(element, { hidden: () => !isShown() });
  }
  return element;
}

/**
 * @param {DeclaredProperty} property
 * @param {Options} options
 * @param {Partial<Parameters<typeof row>[1]>} [others]
 */
function rowOf(property, { values, send, marks, command }, others) {
  const { path } = property;
  return row(property, {
    marks,
    command,
    value: () => values.get(`value.${path}`),
    change: (value) => send(path, value),
    ...others,
  });
}

/**
 * @param {DeclaredProperty} property
 * @param {Options} options
 * @param {number} depth
 */
function topic({ path, label, help, type, children = [] }, options, depth) {
  const [named, ...rest] = children;
  const live = () => options.values.get(`topic.${path}`);
  const name = rowOf({ ...named, kind: "topic", label, help, type }, options, { live });
  const note = el(
    "div",
    { class: "wv-section-note" },
    el("span", {}, () => live()?.qos),
  );
  const inner = rest.map((child) => part(child, options, depth + 1));
  const key = `fold.${options.name}.${path}.qos`;
  return el("div", { class: "wv-topic-property" }, name, foldable(key, "QoS", note, inner, false));
}

/**
 * As in RViz, a group may have a value of its own, which stands in its line.
 *
 * @param {DeclaredProperty} property
 * @param {Options} options
 * @param {number} depth
 */
function section({ path, label, help, children = [] }, options, depth) {
  const own = children.find((child) => child.path === `${path}.value`);
  const inner = children
    .filter((child) => child !== own)
    .map((child) => part(child, options, depth + 1));
  const beside = own && rowOf({ ...own, help: own.help || help }, options);
  return foldable(`fold.${options.name}.${path}`, label, beside, inner, true, help);
}

/**
 * @param {string} key by which this browser remembers whether it is open
 * @param {string} label
 * @param {HTMLElement | undefined} beside
 * @param {HTMLElement[]} children
 * @param {boolean} isOpenAtFirst
 * @param {string} [help]
 */
function foldable(key, label, beside, children, isOpenAtFirst, help = "") {
  const isOpen = signal(recall(key, isOpenAtFirst));
  const toggle = el(
    "button",
    {
      type: "button",
      class: "wv-section-fold",
      title: help || null,
      "aria-label": label,
      "aria-expanded": () => String(isOpen.value),
      onclick: () => remember(key, (isOpen.value = !isOpen.value)),
    },
    icon("chevron", 12),
    beside?.matches(".wv-property") ? null : label,
  );
  const inner = { class: "wv-section-inner", role: "group", "aria-label": label };
  return el(
    "div",
    { class: "wv-section" },
    el("div", { class: "wv-section-head" }, toggle, beside),
    el("div", { ...inner, hidden: () => !isOpen.value }, children),
  );
}
