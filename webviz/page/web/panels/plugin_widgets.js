// The widgets of plug-ins' panels, by their kind: each `{kind, element, update(values)}`.

import { chart } from "../charts/chart.js";
import { combobox } from "../controls/combobox.js";
import { slider } from "../controls/slider.js";
import { sync } from "../controls/sync.js";
import { el, set, setChildren, setText } from "../dom.js";

const TYPING_MS = 600;

const makers = new Map();
const awaited = new Map();

/**
 * Adds a kind of widget. `make(values, send)` returns `{element, update(values), close()}`, the
 * latter if need be; `send(value)` reports its use to the panel.
 */
export function widget(kind, make) {
  makers.set(kind, make);
  for (const draw of awaited.get(kind) ?? []) draw();
  awaited.delete(kind);
}

for (const make of [area, button, checkbox, chart, field, choice, sliders]) widget(make.name, make);

/** A widget of these values; one of a module that is not there yet is drawn later. */
export function makeWidget(values, send) {
  const { kind } = values;
  return { kind, ...(makers.get(kind) ?? later)(values, send) };
}

function later(values, send) {
  const element = el("div", { class: "wv-quiet" }, "This widget needs the module of its panel.");
  let [inner, last] = [null, [values]];
  const draw = () => {
    inner = makers.get(values.kind)(values, send);
    inner.update(...last);
    element.className = "";
    element.replaceChildren(inner.element);
  };
  awaited.set(values.kind, (awaited.get(values.kind) ?? new Set()).add(draw));
  return {
    element,
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

function area() {
  const element = el("div", { class: "wv-plugin-area" });
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

function button({ width }, send) {
  const element = el("button", { type: "button", class: "wv-button", onclick: () => send(null) });
  element.style.setProperty("--wv-share", width);
  function update({ label, hint }) {
    setText(element, label);
    set(element, { "data-tip": hint || null });
  }
  return { element, update };
}

function checkbox(_, send) {
  const box = el("input", { type: "checkbox", onchange: () => state.edit(box.checked) });
  const text = el("span");
  const element = el("label", { class: "wv-plugin-check" }, box, text);
  const state = sync({
    show: (value) => {
      box.checked = value;
    },
    send,
  });
  function update({ label, hint, value }) {
    setText(text, label);
    set(element, { "data-tip": hint || null });
    state.show(value);
  }
  return { element, update };
}

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
  let sent = null;
  const state = sync({
    show: (value) => {
      sent = value;
      if (input.value !== value) input.value = value;
    },
    send,
  });
  function enter() {
    clearTimeout(timer);
    if (input.value === sent) return;
    sent = input.value;
    state.edit(sent);
  }
  function update({ label, hint, value }) {
    setText(name, label);
    set(element, { "data-tip": hint || null });
    state.show(value);
  }
  return { element, update };
}

function choice({ label, value, options }, send) {
  const named = (values) => values.map((each) => ({ value: each, label: each || "(none)" }));
  const box = combobox({ label, value, options: named(options), change: send, free: false });
  const name = el("span", { class: "wv-quiet" });
  const element = el("div", { class: "wv-plugin-line" }, name, box.element);
  function update(values) {
    setText(name, values.label);
    set(element, { "data-tip": values.hint || null });
    box.update({ value: values.value, options: named(values.options) });
  }
  return { element, update };
}

function sliders(_, send) {
  const element = el("div", { class: "wv-plugin-sliders" });
  const made = new Map();
  function make({ name, low, high, unit }) {
    const change = (value) => send(`${value} ${name}`);
    const control = slider(
      { kind: "float", low, high, unit },
      { label: name, change, refused: () => {} },
    );
    const label = el("span", { class: "wv-plugin-slider-name", title: name }, name);
    return { line: el("div", { class: "wv-plugin-line" }, label, control.element), control };
  }
  function update({ slides }) {
    const before = new Map(made);
    made.clear();
    for (const slide of slides) {
      const key = JSON.stringify([slide.name, slide.low, slide.high, slide.unit]);
      made.set(key, before.get(key) ?? make(slide));
      made.get(key).control.update(slide.value);
    }
    setChildren(
      element,
      [...made.values()].map(({ line }) => line),
    );
  }
  return { element, update };
}
