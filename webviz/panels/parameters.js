// The widget "parameters": rows with a field for each value, which is sent on Enter.

import { searchField } from "webviz/controls/fields.js";
import { rowList, touchable } from "webviz/controls/rows.js";
import { el, set, setText, showText } from "webviz/dom.js";
import { download } from "webviz/download.js";
import { iconButton } from "webviz/icons.js";

/** @import {Page} from "../page/web/extensions.js" */

/**
 * @typedef {{
 *   name: string, kind: string, text: string, range: string, about: string, locked: boolean, refused: string,
 * }} Parameter
 * @typedef {Parameter & {key: string}} Row
 * @typedef {{
 *   node: string, rows: Parameter[], note: string, problem: string, outcome: string, undo: number, yaml: string,
 * }} Values
 */

const ROW_PX = 46;

/** @param {Page} page */
export default function install({ widget }) {
  widget("parameters", (_, send) => {
    /** @type {Values} */
    let shown = { node: "", rows: [], note: "", problem: "", outcome: "", undo: 0, yaml: "" };
    const search = searchField("Filter parameters", draw, { placeholder: "Filter" });
    const file = el("input", { type: "file", accept: ".yaml,.yml", hidden: true, onchange: load });
    const undo = iconButton("arrow-back", "Undo the newest change", () => send({ undo: true }));
    const head = el(
      "span",
      { class: "wv-panel-tools" },
      search,
      undo,
      iconButton("refresh", "Read the parameters again", () => send({ refresh: true })),
      iconButton("download", "Save as YAML", () => {
        const name = shown.node.split("/").pop() || "parameters";
        if (shown.yaml) download(`${name}.yaml`, shown.yaml);
      }),
      iconButton("upload", "Load YAML", () => file.click()),
      file,
    );
    const said = el("div", { class: "wv-empty", role: "status" });
    const list = rowList({
      label: "Parameters",
      height: touchable(ROW_PX),
      make,
      update(element, /** @type {Row} */ row) {
        const [name, , about] = element.children;
        setText(name, row.name);
        set(name, { "data-tip": row.name });
        showValue(element, row);
        const texts = [row.kind, row.range, row.locked ? "read only" : "", row.about];
        setText(about, row.refused || texts.filter(Boolean).join(" · "));
        set(element, { "data-level": row.refused ? "error" : null });
        set(about, { "data-tip": about.textContent });
      },
    });

    function make() {
      return el(
        "div",
        { class: "wv-parameter" },
        el("span", { class: "wv-ellipsis" }),
        el("span"),
        el("span", { class: "wv-ellipsis" }),
      );
    }

    /**
     * Shows the value of a parameter, unless somebody is entering another one.
     *
     * @param {Element} element
     * @param {Row} row
     */
    function showValue(element, { name, kind, text, locked }) {
      const isChoice = kind === "bool" && !locked;
      const [, before] = element.children;
      let field = /** @type {HTMLInputElement | HTMLSelectElement} */ (before);
      if (field.matches("select") !== isChoice || !field.matches(".wv-field")) {
        field = isChoice ? choiceOf(name) : fieldOf(name);
        before.replaceWith(field);
      }
      if (document.activeElement !== field || isChoice) field.value = text;
      field.dataset.text = text;
      set(field, { readonly: locked });
    }

    /** @param {string} name */
    function choiceOf(name) {
      const options = ["true", "false"].map((value) => el("option", { value }, value));
      /** @type {HTMLSelectElement} */
      const choice = el(
        "select",
        {
          class: "wv-field",
          "aria-label": name,
          onchange: () => send({ set: [name, choice.value] }),
          onkeydown: (/** @type {KeyboardEvent} */ event) => event.stopPropagation(),
        },
        options,
      );
      return choice;
    }

    /** @param {string} name */
    function fieldOf(name) {
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

    async function load() {
      const text = await file.files?.[0]?.text();
      file.value = "";
      if (text !== undefined) send({ load: text });
    }

    function draw() {
      const part = search.value.toLowerCase();
      list.show(
        shown.rows
          .filter(({ name, about }) => `${name} ${about}`.toLowerCase().includes(part))
          .map((row) => ({ ...row, key: row.name })),
      );
      const sentence = [shown.problem, shown.outcome, shown.note].filter(Boolean).join(" ");
      showText(said, sentence);
      set(undo, { disabled: !shown.undo });
    }

    const element = el("div", { class: "wv-plugin-fill" }, said, list.element);
    return {
      head,
      element,
      update(values) {
        shown = { ...shown, ...values };
        draw();
      },
      close: list.close,
    };
  });
}
