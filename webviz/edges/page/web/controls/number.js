// A number: typed with or without its unit, stepped by arrow keys, dragged sideways.

import { el, set } from "../dom.js";
import { sync } from "./sync.js";
import { format, parse, stepOf, within } from "./units.js";

const DRAG_PX = 4; // less is a click
const STEP_PX = 4;
const DOUBLE_PX = 70; // for what can only be positive, right doubles and left halves

/** A field for a number; see `control.js`. `prefix` stands in it at the left, such as "X". */
export function number(property, { label, change, refused, prefix = "" }) {
  let current;
  let isTyped = false;

  const input = el("input", {
    class: "wv-field", type: "text", role: "spinbutton", inputmode: "decimal", "aria-label": label,
    "aria-valuemin": property.low ?? property.above, "aria-valuemax": property.high ?? property.below,
    autocomplete: "off", spellcheck: "false",
  });
  const element = el(
    "div", { class: "wv-number-input" },
    prefix && el("span", { class: "wv-number-prefix", "aria-hidden": "true" }, prefix),
    input,
    property.unit && el("span", { class: "wv-number-unit", "aria-hidden": "true" }, property.unit),
  );
  const state = sync({
    show(value) {
      current = value;
      write();
    },
    send: change,
    refused(text) {
      set(input, { "aria-invalid": text ? "true" : null });
      refused(text);
    },
  });

  function write() {
    const text = format(current);
    if (input.value !== text) input.value = text;
    set(input, { "aria-valuenow": text, "aria-valuetext": `${text} ${property.unit ?? ""}`.trim() });
  }

  function take() {
    isTyped = false;
    if (input.value.trim() === format(current) && !input.getAttribute("aria-invalid")) {
      return state.release();
    }
    try {
      const value = parse(input.value, property.unit);
      if (property.kind === "int" && !Number.isInteger(value)) {
        throw new Error(`Not changed: expected a whole number, got ${format(value)}.`);
      }
      current = value;
      state.release();
      state.edit(value);
    } catch (error) {
      state.refuse(error.message);
    }
  }

  function put(value) {
    if (value === current) return;
    current = value;
    write();
    state.edit(value);
  }

  function step(event) {
    const by = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
    const size = stepOf(property, current) * (property.kind !== "int" && event.altKey ? 0.1 : 1);
    put(within(property, current + by * size * (event.shiftKey ? 10 : 1), size));
    input.select();
  }

  input.addEventListener("input", () => {
    isTyped = true;
    state.hold();
  });
  input.addEventListener("keydown", (event) => {
    if (event.key === "Enter") {
      take();
      input.select();
    } else if (event.key === "Escape") {
      if (!isTyped && !input.getAttribute("aria-invalid")) return;
      isTyped = false;
      state.cancel();
      write();
      input.select();
    } else if (/^(Arrow(Up|Down)|Page(Up|Down))$/.test(event.key)) {
      if (isTyped) take();
      if (!input.getAttribute("aria-invalid")) step(event);
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  });
  input.addEventListener("blur", () => {
    if (isTyped) take();
  });
  drag(input, {
    begin: () => (isTyped ? null : { value: current, size: stepOf(property, current) }),
    move({ value, size }, by) {
      state.hold();
      const isScale = property.above === 0 && property.kind !== "int";
      const moved = isScale ? value * 2 ** (by / DOUBLE_PX) : value + Math.round(by / STEP_PX) * size;
      put(within(property, moved, isScale ? size / 10 : size));
    },
    end: state.release,
  });

  return {
    element,
    focus: () => input.focus(),
    describe: (text) => set(input, { title: text }),
    update: state.show,
  };
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
