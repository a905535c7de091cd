// The widgets of plug-ins' panels, by their kind: each `{kind, element, update(values)}`.

import { chart } from "webviz/charts/chart.js";
import { combobox } from "webviz/controls/combobox.js";
import { slider } from "webviz/controls/slider.js";
import { sync } from "webviz/controls/sync.js";
import { el, setText } from "webviz/dom.js";
import { computed, each, root, signal, untracked } from "webviz/signals.js";

/** @import {ValuesOf} from "webviz/types.js" */
/** @import {Field} from "webviz/panels/field_drag.js" */
/** @import {Signal} from "webviz/signals.js" */

/**
 * Values of a widget, which its panel in Python makes; each kind reads those that it has.
 *
 * @typedef {{[value: string]: unknown}} WidgetValues
 * @typedef {{label: string, hint: string}} Labelled
 * @typedef {{name: string, value: number, low: number, high: number, unit: string}} Slide
 * @typedef {Labelled & {value: string, options: string[]}} Choices
 * @typedef {(value: boolean | string | null) => unknown} Send
 * @typedef {{
 *   element?: HTMLElement, head?: HTMLElement, close?(): void, drop?(field: Field): unknown,
 *   update(values: WidgetValues, store: ValuesOf<"panel">, id: string): void,
 * }} Widget
 *   `head` stands in the head of the panel, `drop` takes a field that is dropped on the panel
 * @typedef {{make(values: WidgetValues, send: Send): Widget}["make"]} MakeWidget
 */

const TYPING_MS = 600;

/** @type {Map<string, MakeWidget>} */
const factories = new Map();
/** @type {Map<string, Set<() => void>>} */
const awaited = new Map();

/**
 * Adds a kind of widget. `make(values, send)` returns `{element, update(values), close()}`, the
 * latter if need be; `send(value)` reports its use to the panel.
 *
 * @param {string} kind
 * @param {MakeWidget} make
 */
export function widget(kind, make) {
  factories.set(kind, make);
  for (const draw of awaited.get(kind) ?? []) draw();
  awaited.delete(kind);
}

/**
 * A widget of these values; one of a module that is not there yet is drawn later.
 *
 * @param {WidgetValues & {kind: string}} values
 * @param {Send} send
 * @returns {Widget & {kind: string}}
 */
export const makeWidget = (values, send) =>
  root((end) => {
    const { kind } = values;
    const instance = (factories.get(kind) ?? later)(values, send);
    return {
      kind,
      ...instance,
      close() {
        instance.close?.();
        end();
      },
    };
  });

/** @type {MakeWidget} */
function later(values, send) {
  const kind = String(values.kind);
  const element = el("div", { class: "wv-quiet" }, "This widget needs the module of its panel.");
  const head = el("span", { class: "wv-panel-tools" });
  /** @type {Widget | null} */
  let inner = null;
  /** @type {Parameters<Widget["update"]> | null} */
  let last = null;
  const draw = () => {
    inner = factories.get(kind)?.(values, send) ?? null;
    if (!inner) return;
    if (last) inner.update(...last);
    element.className = "";
    element.replaceChildren(...(inner.element ? [inner.element] : []));
    if (inner.head) head.append(inner.head);
  };
  awaited.set(kind, (awaited.get(kind) ?? new Set()).add(draw));
  return {
    element,
    head,
    /** @param {Parameters<Widget["update"]>} args */
    update(...args) {
      last = args;
      inner?.update(...args);
    },
    close() {
      awaited.get(kind)?.delete(draw);
      inner?.close?.();
    },
  };
}

/** @returns {Widget} */
function area() {
  const element = el("div", { class: "wv-plugin-area" });
  /** @param {{text?: string, lines?: string[], table?: string[][], html?: string}} values */
  function update({ text = "", lines, table, html }) {
    // The one place where markup comes to the page: what a plug-in makes is as trusted as its code.
    if (html !== undefined) element.innerHTML = html;
    else if (lines) element.replaceChildren(el("pre", {}, lines.join("\n")));
    else if (table) element.replaceChildren(tableOf(table));
    else setText(element, text);
    element.hidden = !element.hasChildNodes();
  }
  return { element, update };
}

/** @param {string[][]} rows */
function tableOf(rows) {
  return el(
    "table",
    {},
    el(
      "tbody",
      {},
      rows.map((row) =>
        el(
          "tr",
          {},
          row.map((cell) => el("td", {}, cell)),
        ),
      ),
    ),
  );
}

/**
 * A kind whose elements follow its values.
 *
 * @template V
 * @param {(values: () => V, send: Send) => HTMLElement} make
 * @returns {MakeWidget}
 */
const following = (make) => (values, send) => {
  const latest = signal(/** @type {V} */ (values));
  return {
    element: make(() => latest.value, send),
    update: (next) => (latest.value = /** @type {V} */ (next)),
  };
};

/** @param {() => Labelled} values */
const labelOf = (values) => () => values().label;

/** @param {() => Labelled} values */
const tipOf = (values) => () => values().hint || null;

const button = following((/** @type {() => Labelled & {width: number}} */ values, send) =>
  el(
    "button",
    {
      type: "button",
      class: "wv-button",
      style: () => `--wv-share: ${values().width}`,
      "data-tip": tipOf(values),
      onclick: () => send(null),
    },
    labelOf(values),
  ),
);

const checkbox = following((/** @type {() => Labelled & {value: boolean}} */ values, send) => {
  /** @type {HTMLInputElement} */
  const box = el("input", { type: "checkbox", onchange: () => state.edit(box.checked) });
  const current = computed(() => values().value);
  const state = sync({
    value: () => current.value,
    show: (value) => (box.checked = value === true),
    change: send,
  });
  return el(
    "label",
    { class: "wv-plugin-check", "data-tip": tipOf(values) },
    box,
    el("span", {}, labelOf(values)),
  );
});

const field = following((/** @type {() => Labelled & {value: string}} */ values, send) => {
  let timer = 0;
  /** @type {HTMLInputElement} */
  const input = el("input", {
    class: "wv-field",
    type: "text",
    onfocus: () => state.hold(),
    oninput: () => {
      clearTimeout(timer);
      timer = setTimeout(enter, TYPING_MS);
    },
    onchange: enter,
    onblur: () => state.release(),
  });
  /** @type {string | null} */
  let lastValue = null;
  const current = computed(() => values().value);
  const state = sync({
    value: () => current.value,
    show(value) {
      lastValue = String(value);
      if (input.value !== lastValue) input.value = lastValue;
    },
    change: send,
  });
  function enter() {
    clearTimeout(timer);
    if (input.value === lastValue) return;
    lastValue = input.value;
    state.edit(lastValue);
  }
  return line(values, input);
});

const choice = following((/** @type {() => Choices} */ values, send) => {
  const box = combobox({
    label: untracked(values).label,
    value: () => values().value,
    options: () => values().options.map((value) => ({ value, label: value || "(none)" })),
    change: send,
    free: false,
  });
  return line(values, box.element, "div");
});

/**
 * A control behind its label.
 *
 * @param {() => Labelled} values
 * @param {HTMLElement} control
 * @param {"label" | "div"} [tag]
 */
const line = (values, control, tag = "label") =>
  el(
    tag,
    { class: "wv-plugin-line", "data-tip": tipOf(values) },
    el("span", { class: "wv-quiet" }, labelOf(values)),
    control,
  );

const sliders = following((/** @type {() => {slides: Slide[]}} */ values, send) => {
  const slides = each(
    () => values().slides,
    ({ name, low, high, unit }) => JSON.stringify([name, low, high, unit]),
    slide,
  );
  return el("div", { class: "wv-plugin-sliders" }, slides);

  /** @param {Signal<Slide>} model */
  function slide(model) {
    const { name, low, high, unit } = untracked(() => model.value);
    const value = computed(() => model.value.value);
    const control = slider(
      { kind: "float", low, high, unit },
      {
        label: name,
        value: () => value.value,
        change: (to) => send(`${Number(to)} ${name}`),
        refused: () => {},
      },
    );
    const label = el("span", { class: "wv-plugin-slider-name", title: name }, name);
    return el("div", { class: "wv-plugin-line" }, label, control.element);
  }
});

const KINDS = { area, button, checkbox, chart, field, choice, sliders };
for (const [kind, make] of Object.entries(KINDS)) widget(kind, make);
