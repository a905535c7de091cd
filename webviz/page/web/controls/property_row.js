// One property: its label, its control, and what leads back to the default.

import { holder, why } from "webviz/access.js";
import { el } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { computed, signal } from "webviz/signals.js";
import { control } from "webviz/controls/control.js";
import { bounds } from "webviz/controls/units.js";

/** @import {DeclaredProperty} from "webviz/contents.js" */
/** @import {ControlOptions} from "webviz/types.js" */

/** @type {Partial<Record<DeclaredProperty["kind"], string>>} */
const ITEMS = { dict: "One entry per line, name: value.", list: "One entry per line." };

/**
 * A row for a property as `content/forms.py` declares it; see `ControlOptions`. `marks`: whether it
 * shows what differs from the default; `command`: see `form`.
 *
 * @param {DeclaredProperty} property
 * @param {Omit<ControlOptions, "label" | "refused"> & {marks: boolean, command: string}} options
 */
export function row(property, { marks, command, ...options }) {
  const { path, label, kind, default: standard } = property;
  const refusal = signal("");
  const isChanged = computed(() => {
    const value = options.value();
    return marks && value !== undefined && JSON.stringify(value) !== JSON.stringify(standard);
  });
  const help = about(property);
  const field = control(property, {
    ...options,
    label,
    help,
    refused: (text) => (refusal.value = text),
  });
  const name = el(
    "span",
    {
      class: field.handle ? "wv-property-label wv-property-handle" : "wv-property-label",
      title: help,
      onclick: field.handle ? undefined : field.focus,
    },
    label,
  );
  field.handle?.(name);
  const reset = el(
    "button",
    {
      type: "button",
      class: "wv-icon wv-property-reset",
      title: standard === undefined ? null : `Reset to ${words(property, standard)}`,
      "aria-label": `Reset ${label}`,
      hidden: () => !isChanged.value || standard === undefined || Boolean(command && why(command)),
      onclick() {
        refusal.value = "";
        options.change(standard);
        field.focus();
      },
    },
    icon("reset", 14),
  );
  return el(
    "div",
    {
      class: "wv-property",
      "data-kind": kind,
      "data-path": path,
      "data-changed": isChanged,
      role: "group",
      "aria-label": label,
      "aria-invalid": () => (refusal.value ? "true" : null),
    },
    name,
    holder(command, { class: "wv-property-control" }, field.element),
    reset,
    el("div", { class: "wv-refused", role: "alert", hidden: () => !refusal.value }, refusal),
  );
}

/**
 * The tooltip of a property: its purpose, its bounds and its default.
 *
 * @param {DeclaredProperty} property
 */
function about(property) {
  const range = bounds(property);
  const items = ITEMS[property.kind];
  const facts = [
    property.help,
    property.type,
    items,
    range && `Range: ${range}.`,
    property.default !== undefined && `Default: ${words(property, property.default)}.`,
  ];
  return facts.filter(Boolean).join("\n");
}

/**
 * @param {DeclaredProperty} property
 * @param {unknown} value
 */
function words({ kind, unit }, value) {
  if (kind === "bool") return value ? "on" : "off";
  if (value === null) return "automatic";
  if (Array.isArray(value)) return value.length ? value.join(", ") : "none";
  if (typeof value === "object") return Object.keys(value).length ? JSON.stringify(value) : "none";
  if (value === "") return "none";
  return unit ? `${value} ${unit}` : String(value);
}
