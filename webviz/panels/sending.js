// The widget "form": fields of a message and its YAML, a button that sends it, history and presets.

import { combobox } from "webviz/controls/combobox.js";
import { openMenuBelow } from "webviz/controls/menu.js";
import { permission } from "webviz/controls/permission.js";
import { el, set } from "webviz/dom.js";
import { textButton } from "webviz/icons.js";
import { messageRows } from "webviz/panels/message_rows.js";
import { computed, each, effect, signal } from "webviz/signals.js";

/** @import {Page} from "../page/web/extensions.js" */

/**
 * `use` says what sending is, such as "call /calibrate"; what is refused is shown before the fields.
 *
 * @typedef {{
 *   verb: string, use: string, name: string, label: string, names: string[], about: string, yaml: string,
 *   fields: {path: string, text: string}[], history: string[], presets: Record<string, string>,
 *   problem: string, outcome: string, failed: boolean, repeats?: boolean, rate?: number, response?: any,
 * }} Form
 * @typedef {() => Form} Read
 * @typedef {(value: object) => unknown} Send
 */

/** @type {Form} */
const NONE = {
  ...{ verb: "", use: "", name: "", label: "", names: [], about: "", yaml: "", fields: [] },
  ...{ history: [], presets: {}, problem: "", outcome: "", failed: false },
};
const HEIGHT = "200px"; // of the response
const LONGEST = 60; // characters of what was sent, in a menu

/** @param {Page} page */
export default function install(page) {
  page.widget("form", (_, send) => {
    const latest = signal(NONE);
    const form = () => latest.value;
    const name = computed(() => (form().name.startsWith("/") ? form().name : ""));
    const right = permission({
      name: () => name.value,
      use: () => form().use,
    });
    const response = messageRows({ label: "Response", topic: () => "" });
    response.element.style.height = HEIGHT;
    set(response.element, { hidden: () => !form().response });
    const element = el(
      "div",
      { class: "wv-sending" },
      target(form, send),
      el("div", { class: "wv-quiet" }, () => form().about),
      right.element,
      fields(form, send),
      yaml(form, send),
      el(
        "div",
        {
          class: "wv-sending-said",
          role: "status",
          "data-level": () => (form().problem || form().failed ? "error" : null),
        },
        () => form().problem || form().outcome,
      ),
      buttons(form, send, right.isRefused),
      el("div", { class: "wv-plugin-bar" }, before(form, send), preset(send)),
      response.element,
    );
    return {
      element,
      update(/** @type {Form} */ values) {
        if (!values.verb) return;
        latest.value = values;
        response.show(values.response ?? null);
      },
      close: response.close,
    };
  });
}

/**
 * The name to send to, with those that are offered.
 *
 * @param {Read} form
 * @param {Send} send
 */
function target(form, send) {
  const label = computed(() => form().label);
  return el(
    "div",
    { class: "wv-plugin-line" },
    el("span", { class: "wv-quiet", "aria-hidden": "true" }, () => form().label),
    () =>
      combobox({
        label: label.value,
        value: () => form().name,
        options: () => form().names.map((value) => ({ value })),
        change: (name) => send({ name }),
      }).element,
  );
}

/**
 * A field for each value of the message.
 *
 * @param {Read} form
 * @param {Send} send
 */
function fields(form, send) {
  const rows = each(
    () => form().fields,
    ({ path }) => path,
    (item, path) => {
      /** @type {HTMLInputElement} */
      const input = el("input", {
        class: "wv-field",
        type: "text",
        "aria-label": path,
        onchange: () => send({ field: [path, input.value] }),
      });
      effect(() => {
        input.value = item.value.text;
      });
      return el(
        "label",
        { class: "wv-sending-field" },
        el("span", { class: "wv-ellipsis", "data-tip": path }, path),
        input,
      );
    },
  );
  return el("div", { class: "wv-sending-fields" }, rows);
}

/**
 * @param {Read} form
 * @param {Send} send
 */
function yaml(form, send) {
  /** @type {HTMLTextAreaElement} */
  const area = el("textarea", {
    class: "wv-field",
    "aria-label": "YAML",
    spellcheck: "false",
    onchange: () => send({ yaml: area.value }),
  });
  const text = computed(() => form().yaml);
  effect(() => {
    area.value = text.value;
  });
  return area;
}

/**
 * @param {Read} form
 * @param {Send} send
 * @param {() => boolean} isRefused
 */
function buttons(form, send, isRefused) {
  const go = { class: "wv-button", type: "button", disabled: isRefused, onclick: () => send({}) };
  const repeats = () => form().repeats === true;
  const repeat = {
    class: "wv-button",
    type: "button",
    hidden: () => form().rate === undefined,
    disabled: () => isRefused() && !repeats(),
    "aria-pressed": repeats,
    onclick: () => send({ repeat: !repeats() }),
  };
  return el(
    "div",
    { class: "wv-plugin-bar" },
    el("button", go, () => form().verb),
    el("button", repeat, () => (repeats() ? "Stop" : `Repeat at ${form().rate} Hz`)),
    textButton("Defaults", () => send({ reset: true })),
  );
}

/**
 * A menu of what was sent before, and of presets.
 *
 * @param {Read} form
 * @param {Send} send
 */
function before(form, send) {
  const presets = () => Object.keys(form().presets);
  const items = () => [
    ...presets().map((label) => ({ label, run: () => send({ preset: label }) })),
    ...(presets().length && form().history.length ? [null] : []),
    ...form().history.map((yaml) => ({
      label: yaml.replaceAll("\n", " ").slice(0, LONGEST),
      run: () => send({ yaml }),
    })),
  ];
  /** @type {HTMLButtonElement} */
  const button = textButton("History and presets", () => openMenuBelow(button, items()), {
    "aria-haspopup": "menu",
    disabled: () => !presets().length && !form().history.length,
  });
  return button;
}

/**
 * @param {Send} send
 */
function preset(send) {
  /** @type {HTMLInputElement} */
  const name = el("input", {
    class: "wv-field",
    type: "text",
    placeholder: "Save as preset",
    "aria-label": "Name of a preset",
    onchange: () => {
      send({ keep: name.value });
      name.value = "";
    },
  });
  return name;
}
