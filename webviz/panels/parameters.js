// The widget "parameters": rows with a field for each value, which is sent on Enter.

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
const RULES = `
.wv-parameter { display: grid; grid-template: 20px 20px / minmax(0, 3fr) minmax(0, 2fr); height: 46px; align-content: center;
  column-gap: 8px; padding-left: var(--wv-edge) }
.wv-parameter > :nth-child(2) { grid-row: span 2; align-self: center }
.wv-parameter > :nth-child(3) { font-size: 12px; color: var(--wv-quiet) }
.wv-parameter[data-level="error"] > :nth-child(3) { color: var(--wv-error) }
`;

/** @param {Page} page */
export default function install({
  download,
  el,
  iconButton,
  rowList,
  set,
  setText,
  style,
  ...page
}) {
  const { touchable, widget } = page;
  style("parameters", RULES);
  widget("parameters", (_, send) => {
    /** @type {Values} */
    let shown = { node: "", rows: [], note: "", problem: "", outcome: "", undo: 0, yaml: "" };
    const search = el("input", {
      class: "wv-field",
      type: "search",
      placeholder: "Filter",
      "aria-label": "Filter parameters",
      oninput: draw,
    });
    const file = el("input", { type: "file", accept: ".yaml,.yml", hidden: true, onchange: load });
    const undo = iconButton("arrow-back", "Undo the newest change", () => send({ undo: true }));
    const bar = el(
      "div",
      { class: "wv-plugin-bar" },
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
        const [name, input, about] = element.children;
        setText(name, row.name);
        const field = /** @type {HTMLInputElement} */ (input);
        if (document.activeElement !== field) field.value = row.text;
        set(field, { "aria-label": row.name, readonly: row.locked });
        const texts = [row.kind, row.range, row.locked ? "read only" : "", row.about];
        setText(about, row.refused || texts.filter(Boolean).join(" · "));
        set(element, { "data-level": row.refused ? "error" : null });
        set(about, { "data-tip": about.textContent });
      },
    });

    function make() {
      /** @type {HTMLInputElement} */
      const input = el("input", {
        class: "wv-field",
        type: "text",
        onchange: () => send({ set: [input.getAttribute("aria-label"), input.value] }),
        onkeydown: (event) => event.stopPropagation(),
      });
      return el(
        "div",
        { class: "wv-parameter" },
        el("span", { class: "wv-ellipsis" }),
        input,
        el("span", { class: "wv-ellipsis" }),
      );
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
      setText(said, sentence);
      set(said, { hidden: !sentence });
      set(undo, { disabled: !shown.undo });
    }

    const element = el("div", { class: "wv-plugin-fill" }, bar, said, list.element);
    return {
      element,
      update(values) {
        shown = { ...shown, ...values };
        draw();
      },
      close: list.close,
    };
  });
}
