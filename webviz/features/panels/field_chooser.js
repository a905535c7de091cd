// The widgets "fields" and "path" of panels that show fields of messages: what adds one, and what
// chooses the one that is shown. Both stand in the head of their panel.

import { combobox } from "webviz/controls/combobox.js";
import { textField } from "webviz/controls/fields.js";
import { OptionList, search } from "webviz/controls/option_list.js";
import { popoverButton } from "webviz/controls/popover.js";
import { el } from "webviz/dom.js";
import { computed, effect, signal } from "webviz/signals.js";
import { messagePath } from "webviz/panels/field_drag.js";
import { widget } from "webviz/panels/plugin_widgets.js";

/** @import {Signal} from "webviz/signals.js" */
/** @import {MakeWidget, Send} from "webviz/panels/plugin_widgets.js" */

/**
 * @typedef {{what: string, topic: string, topics: string[], fields: string[]}} Fields `fields` of the
 *   newest message of the `topic` that is chosen
 * @typedef {{path: string, topics: string[]}} Path
 */

const MAX_SHOWN = 100;

export function install() {
  widget("own fields", fields);
  widget("own path", path);
}

/** @type {MakeWidget} */
function fields(_, send) {
  /** @type {Fields} */
  const none = { what: "field", topic: "", topics: [], fields: [] };
  const latest = signal(none);
  const head = popoverButton(
    "plus",
    "Add a field",
    () => [el("h3", {}, () => `Add a ${latest.value.what}`), choosers(latest, send)],
    { class: "wv-icon wv-add-field" },
  );
  return {
    head,
    update: ({ values }) => (latest.value = /** @type {Fields} */ (values)),
    drop(field) {
      if (field.path) return send(JSON.stringify({ add: messagePath(field) }));
      send(JSON.stringify({ topic: messagePath(field) }));
      if (head.getAttribute("aria-expanded") !== "true") head.click();
    },
  };
}

/**
 * A topic, and its fields below it.
 *
 * @param {Signal<Fields>} latest
 * @param {Send} send
 */
function choosers(latest, send) {
  const topics = combobox({
    label: "Topic",
    value: () => latest.value.topic,
    options: () => latest.value.topics.map((value) => ({ value })),
    change: (topic) => send(JSON.stringify({ topic })),
    free: false,
    placeholder: "Topic",
  });
  const text = signal("");
  const input = textField("Field", { class: "wv-field", placeholder: "Search fields" });
  const list = new OptionList(input, "Fields", ({ id }) =>
    send(JSON.stringify({ add: messagePath({ topic: latest.value.topic, path: String(id) }) })),
  );
  input.addEventListener("input", () => (text.value = input.value));
  const matches = () => search(latest.value.fields, text.value, (field) => [field, ""]);
  effect(() =>
    list.show(
      matches()
        .slice(0, MAX_SHOWN)
        .map((field) => ({ id: field, title: field })),
    ),
  );
  const note = () => {
    if (matches().length) return "";
    if (!latest.value.topic) return "Choose a topic. Fields can also be dragged here from Topics.";
    return latest.value.fields.length ? "No match." : "Waiting for a message …";
  };
  const hasNoTopic = () => !latest.value.topic;
  const topic = computed(() => latest.value.topic);
  effect(() => {
    if (topic.value) queueMicrotask(() => input.focus()); // its fields are what comes next
  });
  return el(
    "div",
    { class: "wv-field-chooser" },
    topics.element,
    el("div", { hidden: hasNoTopic }, input),
    list.element,
    el("p", { class: "wv-quiet", role: "status", hidden: () => !note() }, note),
  );
}

/** @type {MakeWidget} */
function path(_, send) {
  /** @type {Path} */
  const none = { path: "", topics: [] };
  const latest = signal(none);
  const box = combobox({
    label: "Message path",
    value: () => latest.value.path,
    options: () => latest.value.topics.map((value) => ({ value })),
    change: (path) => send(JSON.stringify(path)),
    placeholder: "Topic, fields and filters",
    help: "Topic, fields and filters, such as /diagnostics.status[:]",
  });
  return {
    head: el("div", { class: "wv-panel-path" }, box.element),
    update: ({ values }) => (latest.value = /** @type {Path} */ (values)),
    drop: (field) => send(JSON.stringify(messagePath(field))),
  };
}
