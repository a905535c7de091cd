// The panels of plug-ins: what a Python program has recorded of widgets, drawn.

import { needs } from "../access.js";
import { act } from "../act.js";
import { declaredForm, form } from "../controls/form.js";
import { el, setChildren, showText } from "../dom.js";
import { textButton } from "../icons.js";
import { provide } from "../commands.js";
import { store, watch } from "../stores.js";
import { makeWidget } from "./plugin_widgets.js";

/** @import {Panel, SendProperty, ValuesOf} from "../types.js" */
/** @import {PanelType} from "../contents.js" */
/** @import {Widget, WidgetValues} from "./plugin_widgets.js" */

/**
 * Calls `offer(panels)` with the panels of plug-ins whenever they change, `types(types)` likewise.
 *
 * @param {(panels: Panel[]) => void} offer
 * @param {(types: PanelType[]) => void} types
 */
export function followPlugins(offer, types) {
  watch("panels", (values, changed) => {
    if (changed.has("/types")) types(values.get("/types"));
    offer(
      values.get("/order").map((name) => ({
        name: `plugin-${name}`,
        title: values.get(name) ?? name,
        open: (/** @type {HTMLElement} */ element) => open(element, name),
      })),
    );
  });
  /** @type {ValuesOf<"commands">} */
  let commands = new Map();
  watch("commands", (values) => {
    commands = values;
  });
  provide(() =>
    [...commands.values()].map(({ panel, widget, label, key }) => ({
      name: label,
      key: key || undefined,
      group: "Panels",
      needs: "UseWidget",
      run: () => act("UseWidget", { panel, widget }),
    })),
  );
}

const LOOKED_AT = new Set(["area", "chart"]); // what a chart lets people change has its own locks

/**
 * @param {HTMLElement} element
 * @param {string} name
 */
function open(element, name) {
  const failure = el("div", {
    class: "wv-plugin-failure",
    role: "alert",
    hidden: true,
    "data-level": "error",
  });
  const place = el("div", { class: "wv-plugin-widgets" });
  element.append(el("div", { class: "wv-plugin" }, failure, place), ...properties(name));
  /** @type {Map<string, Widget & {kind: string}>} */
  const drawn = new Map();

  const end = watch(`panel:${name}`, (values, changed) => {
    const order = values.get("/order") ?? [];
    for (const id of order) {
      const widget = /** @type {WidgetValues & {kind: string}} */ (values.get(id));
      const before = drawn.get(id);
      if (before?.kind === widget.kind) {
        const isChanged = changed.has(id) || [...changed].some((key) => key.startsWith(`${id}/`));
        if (isChanged) before.update(widget, values, id);
        continue;
      }
      // A panel that was loaded again may have another widget under the same id.
      before?.close?.();
      const made = makeWidget(widget, (value) =>
        act("UseWidget", { panel: name, widget: id, value }),
      );
      drawn.set(id, made);
      made.update(widget, values, id);
      if (!LOOKED_AT.has(widget.kind)) needs("UseWidget", made.element);
    }
    setChildren(
      place,
      order.flatMap((id) => drawn.get(id)?.element ?? []),
    );
    const sentence = values.get("/failure") ?? "";
    showText(failure, sentence);
  });
  return () => {
    end();
    for (const widget of drawn.values()) widget.close?.();
  };
}

/**
 * The elements with the properties of a panel.
 *
 * @param {string} name
 */
function properties(name) {
  const values = store(`panel_properties:${name}`);
  const id = () => values.get("id") ?? "";
  /** @type {SendProperty} */
  const send = (path, value) =>
    act("SetPanelProperty", { panel: id(), path, value }, { quiet: true, errors: "caller" });
  const options = { values, send, command: "SetPanelProperty" };
  const fields = declaredForm(values, (declared) =>
    form(declared, { ...options, name: `panel.${values.get("type")}` }),
  );
  const remove = textButton("Remove panel", () => act("RemovePanel", { panel: id() }), {
    class: "wv-plugin-remove",
    hidden: () => !id(),
  });
  return [
    el(
      "details",
      { class: "wv-tool-properties", hidden: () => !values.get("declared")?.length },
      el("summary", {}, "Properties"),
      el("div", {}, fields),
    ),
    needs("RemovePanel", remove),
  ];
}
