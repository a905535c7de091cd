// The widgets of plug-ins' panels, by their kind: each `{kind, element, update(values)}`.

import { chart } from "webviz/charts/chart.js";
import { combobox } from "webviz/controls/combobox.js";
import { slider } from "webviz/controls/slider.js";
import { sync } from "webviz/controls/sync.js";
import { el, set, setChildren, setText } from "webviz/dom.js";
import { signal } from "webviz/signals.js";

/** @import {ValuesOf} from "webviz/types.js" */
/** @import {Field} from "webviz/panels/field_drag.js" */

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
const makers = new Map();
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
  makers.set(kind, make);
  for (const draw of awaited.get(kind) ?? []) draw();
  awaited.delete(kind);
}

for (const make of [area, button, checkbox, chart, field, choice, sliders]) widget(make.name, make);

/**
 * A widget of these values; one of a module that is not there yet is drawn later.
 *
 * @param {WidgetValues & {kind: string}} values
 * @param {Send} send
 * @returns {Widget & {kind: string}}
 */
export function makeWidget(values, send) {
  const { kind } = values;
  const make = makers.get(kind);
  return { kind, ...(make ? make(values, send) : later(values, send)) };
}

/**
 * @param {WidgetValues & {kind: string}} values
 * @param {Send} send
 * @returns {Widget}
 */
function later(values, send) {
  const element = el("div", { class: "wv-quiet" }, "This widget needs the module of its panel.");
  const head = el("span", { class: "wv-panel-tools" });
  /** @type {Widget | null} */
  let inner = null;
  /** @type {Parameters<Widget["update"]> | null} */
  let last = null;
  const draw = () => {
    inner = makers.get(values.kind)?.(values, send) ?? null;
    if (!inner) return;
    if (last) inner.update(...last);
    element.className = "";
    element.replaceChildren(...(inner.element ? [inner.element] : []));
    if (inner.head) head.append(inner.head);
  };
  awaited.set(values.kind, (awaited.get(values.kind) ?? new Set()).add(draw));
  return {
    element,
    head,
    /** @param {Parameters<Widget["update"]>} args */
    update(...args) {
      last = args;
      inner?.update(...args);
    },
    close() {
      awaited.get(values.kind)?.delete(draw);
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
 * @param {{width: number}} values
 * @param {Send} send
 * @returns {Widget}
 */
function button({ width }, send) {
  const element = el("button", { type: "button", class: "wv-button", onclick: () => send(null) });
  element.style.setProperty("--wv-share", String(width));
  /** @param {Labelled} values */
  function update({ label, hint }) {
    setText(element, label);
    set(element, { "data-tip": hint || null });
  }
  return { element, update };
}

/**
 * @param {unknown} _
 * @param {Send} send
 * @returns {Widget}
 */
function checkbox(_, send) {
  /** @type {HTMLInputElement} */
  const box = el("input", { type: "checkbox", onchange: () => state.edit(box.checked) });
  const text = el("span");
  const element = el("label", { class: "wv-plugin-check" }, box, text);
  const shown = signal(/** @type {boolean | undefined} */ (undefined));
  const state = sync({
    value: () => shown.value,
    show: (value) => (box.checked = value === true),
    change: send,
  });
  /** @param {Labelled & {value: boolean}} values */
  function update({ label, hint, value }) {
    setText(text, label);
    set(element, { "data-tip": hint || null });
    shown.value = value;
  }
  return { element, update };
}

/**
 * @param {unknown} _
 * @param {Send} send
 * @returns {Widget}
 */
function field(_, send) {
  let timer = 0;
  const name = el("span", { class: "wv-quiet" });
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
  const element = el("label", { class: "wv-plugin-line" }, name, input);
  /** @type {string | null} */
  let sent = null;
  const shown = signal(/** @type {string | undefined} */ (undefined));
  const state = sync({
    value: () => shown.value,
    show(value) {
      sent = String(value);
      if (input.value !== sent) input.value = sent;
    },
    change: send,
  });
  function enter() {
    clearTimeout(timer);
    if (input.value === sent) return;
    sent = input.value;
    state.edit(sent);
  }
  /** @param {Labelled & {value: string}} values */
  function update({ label, hint, value }) {
    setText(name, label);
    set(element, { "data-tip": hint || null });
    shown.value = value;
  }
  return { element, update };
}

/**
 * @param {Choices} values
 * @param {Send} send
 * @returns {Widget}
 */
function choice(values, send) {
  const shown = signal(values);
  const box = combobox({
    label: values.label,
    value: () => shown.value.value,
    options: () => shown.value.options.map((value) => ({ value, label: value || "(none)" })),
    change: send,
    free: false,
  });
  const element = el(
    "div",
    { class: "wv-plugin-line", "data-tip": () => shown.value.hint || null },
    el("span", { class: "wv-quiet" }, () => shown.value.label),
    box.element,
  );
  /** @param {Choices} next */
  const update = (next) => (shown.value = next);
  return { element, update };
}

/**
 * @param {unknown} _
 * @param {Send} send
 * @returns {Widget}
 */
function sliders(_, send) {
  const element = el("div", { class: "wv-plugin-sliders" });
  /** @type {Map<string, ReturnType<typeof make>>} */
  const made = new Map();
  /** @param {Slide} slide */
  function make({ name, low, high, unit }) {
    /** @param {number} value */
    const change = (value) => send(`${value} ${name}`);
    const shown = signal(/** @type {number | undefined} */ (undefined));
    const value = () => shown.value;
    const control = slider(
      { kind: "float", low, high, unit },
      { label: name, value, change: (value) => change(Number(value)), refused: () => {} },
    );
    const label = el("span", { class: "wv-plugin-slider-name", title: name }, name);
    return { line: el("div", { class: "wv-plugin-line" }, label, control.element), shown };
  }
  /** @param {{slides: Slide[]}} values */
  function update({ slides }) {
    const before = new Map(made);
    made.clear();
    for (const slide of slides) {
      const key = JSON.stringify([slide.name, slide.low, slide.high, slide.unit]);
      const one = before.get(key) ?? make(slide);
      made.set(key, one);
      one.shown.value = slide.value;
    }
    setChildren(
      element,
      [...made.values()].map(({ line }) => line),
    );
  }
  return { element, update };
}
