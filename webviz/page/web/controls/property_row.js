// One property: its label, its control, and what leads back to the default.

import { holder, why } from "../access.js";
import { el, set, showText } from "../dom.js";
import { icon } from "../icons.js";
import { control } from "./control.js";
import { bounds } from "./units.js";

/** @import {DeclaredProperty} from "../contents.js" */
/** @import {Known, SendProperty} from "../types.js" */

/** @type {Partial<Record<DeclaredProperty["kind"], string>>} */
const ITEMS = { dict: "One entry per line, name: value.", list: "One entry per line." };

let count = 0;

/**
 * A row for a property as `content/forms.py` declares it. `send(path, value)` sends it to the viewer, and
 * returns the promise of `act`. `marks`: whether it shows what differs from the default; `command`: see `form`. Returns
 * `{element, update(value), live(known), follow(value), end()}`.
 *
 * @param {DeclaredProperty} property
 * @param {SendProperty} send
 * @param {{marks?: boolean, command?: string}} [options]
 */
export function row(property, send, { marks = true, command = "" } = {}) {
  count += 1;
  const id = `wv-refused-${count}`;
  const { path, label, kind, default: standard } = property;
  const refusal = el("div", { class: "wv-refused", id, role: "alert", hidden: true });
  /** @param {string} text */
  const tell = (text) => {
    showText(refusal, text);
    set(element, { "aria-invalid": text ? "true" : null });
  };
  const made = control(property, { label, change: (value) => send(path, value), refused: tell });
  const reset = el(
    "button",
    {
      type: "button",
      class: "wv-icon wv-property-reset",
      title: standard === undefined ? null : `Reset to ${words(property, standard)}`,
      "aria-label": `Reset ${label}`,
      hidden: true,
      onclick: () => {
        tell("");
        send(path, standard);
        made.focus();
      },
    },
    icon("reset", 14),
  );
  const name = el("span", { class: "wv-property-label" }, label);
  if (made.handle) {
    made.handle(name);
    name.classList.add("wv-property-handle");
  } else name.addEventListener("click", () => made.focus());
  const element = el(
    "div",
    {
      class: "wv-property",
      "data-kind": kind,
      "data-path": path,
      role: "group",
      "aria-label": label,
    },
    name,
    holder(command, { class: "wv-property-control" }, made.element),
    reset,
    refusal,
  );
  const tooltip = about(property);
  set(name, { title: tooltip });
  made.describe(tooltip);

  return {
    element,
    /** @param {unknown} value */
    update(value) {
      made.update(value);
      const isChanged = marks && JSON.stringify(value) !== JSON.stringify(standard);
      set(element, { "data-changed": isChanged });
      const isOffered = isChanged && standard !== undefined && !(command && why(command));
      if (reset.hidden === isOffered) reset.hidden = !isOffered;
    },
    /** @param {Known} known */
    live: (known) => made.live?.(known),
    /** @param {unknown} value */
    follow: (value) => made.follow?.(value),
    end: () => made.end?.(),
  };
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
