// A number: typed with or without its unit, stepped by arrow keys, dragged sideways.

import { el, set } from "../dom.js";
import { entry } from "./entry.js";
import { format, parse, stepOf, within } from "./units.js";

const DRAG_PX = 4; // less is a click
const STEP_PX = 4;
const DOUBLE_PX = 70; // for what can only be positive, right doubles and left halves

/** A field for a number; see `control.js`. `prefix` stands in it at the left, such as "X". */
export function number(property, { label, change, refused, prefix = "" }) {
  const input = el("input", {
    class: "wv-field", type: "text", role: "spinbutton", inputmode: "decimal", "aria-label": label,
    "aria-valuemin": property.low ?? property.above, "aria-valuemax": property.high ?? property.below,
  });
  const element = el(
    "div", { class: "wv-number-input" },
    prefix && el("span", { class: "wv-number-prefix", "aria-hidden": "true" }, prefix),
    input,
    property.unit && el("span", { class: "wv-number-unit", "aria-hidden": "true" }, property.unit),
  );
  const field = entry(input, {
    change,
    refused,
    encode: format,
    decode(text) {
      const value = parse(text, property.unit);
      if (property.kind !== "int" || Number.isInteger(value)) return value;
      throw new Error(`Not changed: expected a whole number, got ${format(value)}.`);
    },
    after() {
      const text = format(field.value());
      set(input, { "aria-valuenow": text, "aria-valuetext": `${text} ${property.unit ?? ""}`.trim() });
    },
  });

  function step(event) {
    const by = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
    const size = stepOf(property, field.value()) * (property.kind !== "int" && event.altKey ? 0.1 : 1);
    field.put(within(property, field.value() + by * size * (event.shiftKey ? 10 : 1), size));
    input.select();
  }

  input.addEventListener("keydown", (event) => {
    if (!/^(Arrow(Up|Down)|Page(Up|Down))$/.test(event.key)) return;
    if (field.isTyped()) field.take();
    if (!input.getAttribute("aria-invalid")) step(event);
    event.preventDefault();
    event.stopPropagation();
  });
  drag(input, {
    begin: () =>
      field.isTyped() ? null : { value: field.value(), size: stepOf(property, field.value()) },
    move({ value, size }, by) {
      field.hold();
      const isScale = property.above === 0 && property.kind !== "int";
      const moved = isScale ? value * 2 ** (by / DOUBLE_PX) : value + Math.round(by / STEP_PX) * size;
      field.put(within(property, moved, isScale ? size / 10 : size));
    },
    end: field.release,
  });

  return { ...field, element };
}

/** Calls `move(start, pixels)` while a field is dragged sideways; a click selects what is in it. */
function drag(input, { begin, move, end }) {
  let from = null;

  input.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || document.activeElement === input) return;
    event.preventDefault(); // it gets the focus when this turns out to be a click
    const start = begin();
    if (start) from = { start, x: event.clientX, isDragged: false };
    input.setPointerCapture(event.pointerId);
  });
  input.addEventListener("pointermove", (event) => {
    if (!from) return;
    const by = event.clientX - from.x;
    if (!from.isDragged && Math.abs(by) < DRAG_PX) return;
    from.isDragged = true;
    move(from.start, by);
  });
  const finish = ({ type }) => {
    if (!from) return;
    const { isDragged } = from;
    from = null;
    if (isDragged) end();
    else if (type === "pointerup") {
      input.focus();
      input.select();
    }
  };
  input.addEventListener("pointerup", finish);
  input.addEventListener("pointercancel", finish);
}
