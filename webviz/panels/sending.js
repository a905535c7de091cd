// The widget "form": fields of a message and its YAML, a button that sends it, history and presets.

import { el, set, setText } from "webviz/dom.js";
import { textButton } from "webviz/icons.js";
import { messageRows } from "webviz/panels/message_rows.js";

/** @import {Page} from "../page/web/extensions.js" */

/**
 * @typedef {{
 *   verb: string, name: string, label: string, names: string[], about: string, yaml: string,
 *   fields: {path: string, text: string}[], history: string[], presets: Record<string, string>,
 *   problem: string, outcome: string, failed: boolean, repeats?: boolean, rate?: number, response?: any,
 * }} Form
 */

let forms = 0;

/** @param {Page} page */
export default function install({ widget }) {
  widget("form", (_, send) => {
    forms += 1;
    /** @type {Form | null} */
    let shown = null;
    const names = el("datalist", { id: `wv-sending-${forms}` });
    /** @type {HTMLInputElement} */
    const name = el("input", {
      class: "wv-field",
      type: "text",
      list: names.id,
      onchange: () => send({ name: name.value }),
    });
    const label = el("span", { class: "wv-quiet" });
    const about = el("div", { class: "wv-quiet" });
    const fields = el("div", { class: "wv-sending-fields" });
    /** @type {HTMLTextAreaElement} */
    const yaml = el("textarea", {
      class: "wv-field",
      "aria-label": "YAML",
      spellcheck: "false",
      onchange: () => send({ yaml: yaml.value }),
    });
    const said = el("div", { class: "wv-sending-said", role: "status" });
    const go = textButton("", () => send({}));
    const repeat = textButton("Repeat", () => send({ repeat: !shown?.repeats }), { hidden: true });
    const reset = textButton("Defaults", () => send({ reset: true }));
    const before = el("select", {
      class: "wv-field",
      "aria-label": "History and presets",
      onchange: () => {
        const [from, which] = [before.value[0], before.value.slice(1)];
        if (from === "p") send({ preset: which });
        else if (from === "h") send({ yaml: shown?.history[Number(which)] ?? "" });
        before.value = "";
      },
    });
    const keep = el("input", {
      class: "wv-field",
      type: "text",
      placeholder: "Save as preset",
      "aria-label": "Name of a preset",
      onchange: () => {
        send({ keep: keep.value });
        keep.value = "";
      },
    });
    const response = messageRows({ label: "Response", topic: () => "" });
    set(response.element, { hidden: true });

    /** @param {Form} form */
    function showFields(form) {
      fields.replaceChildren(
        ...form.fields.flatMap(({ path, text }) => {
          /** @type {HTMLInputElement} */
          const input = el("input", {
            class: "wv-field",
            type: "text",
            "aria-label": path,
            value: text,
            onchange: () => send({ field: [path, input.value] }),
          });
          return [el("span", { class: "wv-ellipsis", "data-tip": path }, path), input];
        }),
      );
    }

    /** @param {Form} form */
    function showBefore({ history, presets }) {
      const options = [
        el("option", { value: "" }, "History and presets"),
        ...Object.keys(presets).map((each) => el("option", { value: `p${each}` }, each)),
        ...history.map((text, i) => {
          const line = text.replaceAll("\n", " ").slice(0, 60);
          return el("option", { value: `h${i}` }, line);
        }),
      ];
      before.replaceChildren(...options);
    }

    const element = el(
      "div",
      { class: "wv-sending" },
      el("label", { class: "wv-plugin-line" }, label, name),
      names,
      about,
      fields,
      yaml,
      said,
      el("div", { class: "wv-plugin-bar" }, go, repeat, reset),
      el("div", { class: "wv-plugin-bar" }, before, keep),
      response.element,
    );
    response.element.style.height = "200px";

    /** @param {Form} form */
    function update(form) {
      if (!form.verb) return;
      const old = shown;
      shown = form;
      setText(label, form.label);
      set(name, { "aria-label": form.label });
      if (document.activeElement !== name) name.value = form.name;
      setText(about, form.about);
      setText(go, form.verb);
      set(repeat, { hidden: form.rate === undefined, "aria-pressed": String(!!form.repeats) });
      if (form.rate !== undefined)
        setText(repeat, form.repeats ? "Stop" : `Repeat at ${form.rate} Hz`);
      if (JSON.stringify(old?.names) !== JSON.stringify(form.names))
        names.replaceChildren(...form.names.map((value) => el("option", { value })));
      if (JSON.stringify(old?.fields) !== JSON.stringify(form.fields)) showFields(form);
      if (old?.yaml !== form.yaml) yaml.value = form.yaml;
      const isSame =
        JSON.stringify([old?.history, old?.presets]) ===
        JSON.stringify([form.history, form.presets]);
      if (!old || !isSame) showBefore(form);
      setText(said, form.problem || form.outcome);
      set(said, { "data-level": form.problem || form.failed ? "error" : null });
      set(response.element, { hidden: !form.response });
      response.show(form.response ?? null);
    }

    return { element, update, close: response.close };
  });
}
