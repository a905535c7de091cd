// A number: typed with or without its unit, stepped by arrow keys, dragged sideways.

import { el, set } from "webviz/dom.js";
import { drag } from "webviz/controls/drag.js";
import { entry } from "webviz/controls/entry.js";
import { textField } from "webviz/controls/fields.js";
import { MIXED_TEXT } from "webviz/controls/mixed.js";
import { format, isAngle, parse, stepOf, unitText, within } from "webviz/controls/units.js";

/** @import {ControlOptions} from "webviz/types.js" */
/** @import {Mixed} from "webviz/controls/mixed.js" */
/** @import {NumberProperty} from "webviz/controls/units.js" */

/** @typedef {ControlOptions<number | Mixed>} NumberOptions */

/** @type {Record<string, number>} */
const STEPS = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 };
const STEP_PX = 4;
const DOUBLE_PX = 70; // for what can only be positive, right doubles and left halves

/**
 * A field for a number; see `control.js`. `prefix` stands in it at the left, such as "X".
 *
 * @param {NumberProperty} property
 * @param {NumberOptions & {prefix?: string}} options
 */
export function number(property, options) {
  const { label, prefix = "" } = options;
  const input = textField(label, {
    role: "spinbutton",
    inputmode: "decimal",
    "aria-valuemin": property.low ?? property.above,
    "aria-valuemax": property.high ?? property.below,
  });
  const field = entry(input, {
    ...options,
    encode: format,
    decode(text) {
      const value = parse(text, property.unit);
      if (property.kind !== "int" || Number.isInteger(value)) return value;
      throw new Error(`Not changed: expected a whole number, got ${format(value)}.`);
    },
  });
  const valueText = () => {
    const text = format(field.current());
    return text ? `${text} ${property.unit ?? ""}`.trim() : MIXED_TEXT;
  };
  set(input, { "aria-valuenow": () => format(field.current()), "aria-valuetext": valueText });
  const unit = el(
    "span",
    {
      class: "wv-number-unit",
      "aria-hidden": "true",
      "data-angle": isAngle(property.unit) ? "" : null,
    },
    () => unitText(property.unit ?? "", field.current()),
  );
  const element = el(
    "div",
    { class: "wv-number-input" },
    prefix && el("span", { class: "wv-number-prefix", "aria-hidden": "true" }, prefix),
    input,
    property.unit && unit,
  );

  stepByKeys(input, property, field);
  const dragged = dragOf(input, property, field);
  drag(input, input, dragged);
  return {
    ...field,
    element,
    handle: (/** @type {HTMLElement} */ label) => drag(label, input, dragged),
  };
}

/** @typedef {ReturnType<typeof entry<number>>} NumberField */

/**
 * Arrow keys and pages step; Shift makes ten times as much of it, Alt a tenth.
 *
 * @param {HTMLInputElement} input
 * @param {NumberProperty} property
 * @param {NumberField} field
 */
function stepByKeys(input, property, field) {
  /** @param {KeyboardEvent} event */
  function step(event) {
    const value = field.current();
    if (typeof value !== "number") return;
    const by = STEPS[event.key];
    const size = stepOf(property, value) * (property.kind !== "int" && event.altKey ? 0.1 : 1);
    field.put(within(property, value + by * size * (event.shiftKey ? 10 : 1), size));
    input.select();
  }

  input.addEventListener("keydown", (event) => {
    if (!Object.hasOwn(STEPS, event.key)) return;
    if (field.isTyped()) field.take();
    if (!input.getAttribute("aria-invalid")) step(event);
    event.preventDefault();
    event.stopPropagation();
  });
}

/**
 * The drag that changes a number, as `drag` takes it.
 *
 * @param {HTMLInputElement} input
 * @param {NumberProperty} property
 * @param {NumberField} field
 */
const dragOf = (input, property, field) => ({
  begin() {
    const value = field.current();
    if (field.isTyped() || typeof value !== "number" || input.matches(":disabled")) return null;
    return { value, size: stepOf(property, value) };
  },
  /**
   * @param {{value: number, size: number}} start
   * @param {number} by pixels
   * @param {boolean} isFine
   */
  move({ value, size }, by, isFine) {
    field.hold();
    const isScale = property.above === 0 && property.kind !== "int";
    const grain = property.kind !== "int" && (isScale || isFine) ? size / 10 : size;
    const moved = isScale
      ? value * 2 ** (by / DOUBLE_PX)
      : value + Math.round(((by / STEP_PX) * size) / grain) * grain;
    field.put(within(property, moved, grain));
  },
  end: field.release,
});
