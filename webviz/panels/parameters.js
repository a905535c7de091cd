// The widget "parameters": rows with a field for each value, which is sent on Enter.

import { searchField } from "webviz/controls/fields.js";
import { permission } from "webviz/controls/permission.js";
import { rowList, touchable } from "webviz/controls/rows.js";
import { el, set, setText } from "webviz/dom.js";
import { download } from "webviz/download.js";
import { iconButton } from "webviz/icons.js";
import { computed, effect, signal } from "webviz/signals.js";

/** @import {Page} from "../page/web/extensions.js" */
/** @import {Signal} from "../page/web/signals.js" */

/**
 * @typedef {{
 *   name: string, kind: string, text: string, range: string, about: string, locked: boolean, refused: string,
 * }} Parameter
 * @typedef {Parameter & {key: string, isReadOnly: boolean}} Row
 * @typedef {{
 *   node: string, rows: Parameter[], note: string, problem: string, outcome: string, undo: number, yaml: string,
 * }} Values
 * @typedef {() => Values} Read
 * @typedef {(value: object) => unknown} Send
 */

const ROW_PX = 46;
/** @type {Values} */
const NONE = { node: "", rows: [], note: "", problem: "", outcome: "", undo: 0, yaml: "" };

/** @param {Page} page */
export default function install(page) {
  page.widget("parameters", (_, send) => {
    /** @type {Signal<Values>} */
    const latest = signal(NONE);
    const read = () => latest.value;
    const part = signal("");
    const node = computed(() => read().node);
    const right = permission({
      name: () => (node.value ? `${node.value}/set_parameters` : ""),
      use: () => `change the parameters of ${node.value}`,
    });
    const search = searchField(
      "Filter parameters",
      () => (part.value = search.value.toLowerCase()),
      { placeholder: "Filter" },
    );
    const list = rowList({ ...rowsOf(send), height: touchable(ROW_PX) });
    effect(() => list.show(rows(read(), part.value, right.isRefused())));
    const sentence = () => [read().problem, read().outcome, read().note].filter(Boolean).join(" ");
    const element = el(
      "div",
      { class: "wv-plugin-fill wv-parameters" },
      right.element,
      el("div", { class: "wv-empty", role: "status", hidden: () => !sentence() }, sentence),
      list.element,
    );
    return {
      head: bar({ read, send, search, isRefused: right.isRefused }),
      element,
      update: (values) => (latest.value = { ...NONE, ...values }),
      close: list.close,
    };
  });
}

/**
 * The rows whose name or description has what is searched for.
 *
 * @param {Values} values
 * @param {string} part
 * @param {boolean} isRefused
 * @returns {Row[]}
 */
const rows = (values, part, isRefused) =>
  values.rows
    .filter(({ name, about }) => `${name} ${about}`.toLowerCase().includes(part))
    .map((row) => ({ ...row, key: row.name, isReadOnly: row.locked || isRefused }));

/**
 * @param {{read: Read, send: Send, search: HTMLElement, isRefused: () => boolean}} options
 */
function bar({ read, send, search, isRefused }) {
  const file = el("input", { type: "file", accept: ".yaml,.yml", hidden: true, onchange: load });
  async function load() {
    const text = await file.files?.[0]?.text();
    file.value = "";
    if (text !== undefined) send({ load: text });
  }
  return el(
    "span",
    { class: "wv-panel-tools" },
    search,
    iconButton("arrow-back", "Undo the newest change", () => send({ undo: true }), {
      disabled: () => !read().undo || isRefused(),
    }),
    iconButton("refresh", "Read the parameters again", () => send({ refresh: true })),
    iconButton("download", "Save as YAML", () => {
      const { node, yaml } = read();
      if (yaml) download(`${node.split("/").pop() || "parameters"}.yaml`, yaml);
    }),
    iconButton("upload", "Load YAML", () => file.click(), { disabled: isRefused }),
    file,
  );
}

/**
 * How a row is made and shown.
 *
 * @param {Send} send
 */
function rowsOf(send) {
  return {
    label: "Parameters",
    make: () =>
      el(
        "div",
        { class: "wv-parameter" },
        el("span", { class: "wv-ellipsis" }),
        el("span"),
        el("span", { class: "wv-ellipsis" }),
      ),
    update(/** @type {Element} */ element, /** @type {Row} */ row) {
      const [name, , about] = element.children;
      setText(name, row.name);
      set(name, { "data-tip": row.name });
      showValue(send, element, row);
      const texts = [row.kind, row.range, row.isReadOnly ? "read only" : "", row.about];
      setText(about, row.refused || texts.filter(Boolean).join(" · "));
      set(element, { "data-level": row.refused ? "error" : null });
      set(about, { "data-tip": about.textContent });
    },
  };
}

/**
 * Shows the value of a parameter, unless the user is entering another one.
 *
 * @param {Send} send
 * @param {Element} element
 * @param {Row} row
 */
function showValue(send, element, { name, kind, text, isReadOnly }) {
  const isSwitch = kind === "bool" && !isReadOnly;
  const [, before] = element.children;
  let field = /** @type {HTMLInputElement} */ (before);
  if (!field.matches(isSwitch ? ".wv-check" : ".wv-field")) {
    field = isSwitch ? checkboxOf(send, name) : fieldOf(send, name);
    before.replaceWith(field);
  }
  if (isSwitch) field.checked = text === "true";
  else if (document.activeElement !== field) field.value = text;
  field.dataset.text = text;
  set(field, { readonly: isReadOnly });
}

/**
 * @param {Send} send
 * @param {string} name
 */
function checkboxOf(send, name) {
  /** @type {HTMLInputElement} */
  const box = el("input", {
    class: "wv-check",
    type: "checkbox",
    "aria-label": name,
    onchange: () => send({ set: [name, String(box.checked)] }),
    onkeydown: (/** @type {KeyboardEvent} */ event) => event.stopPropagation(),
  });
  return box;
}

/**
 * @param {Send} send
 * @param {string} name
 */
function fieldOf(send, name) {
  /** @type {HTMLInputElement} */
  const field = el("input", {
    class: "wv-field",
    type: "text",
    "aria-label": name,
    onchange: () => {
      field.dataset.text = field.value; // until the node says what it has made of it
      send({ set: [name, field.value] });
    },
    onblur: revert,
    onkeydown: (/** @type {KeyboardEvent} */ event) => {
      if (event.key === "Escape") revert();
      event.stopPropagation();
    },
  });
  function revert() {
    field.value = field.dataset.text ?? "";
  }
  return field;
}
