// The panels of plug-ins: what a Python program has recorded of widgets, drawn.

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { declaredForm, form } from "webviz/controls/form.js";
import { popoverButton } from "webviz/controls/popover.js";
import { el, setChildren } from "webviz/dom.js";
import { provide } from "webviz/commands.js";
import { signal } from "webviz/signals.js";
import { once, store, watch } from "webviz/stores.js";
import { toast } from "webviz/toasts.js";
import { start } from "webviz/extensions.js";
import { install as installChooser } from "webviz/features/panels/field_chooser.js";
import { takeFields } from "webviz/panels/field_drag.js";
import { added, types } from "webviz/panels/panels.js";
import { makeWidget } from "webviz/panels/plugin_widgets.js";

/** @import {SendProperty, ValuesOf} from "webviz/types.js" */
/** @import {Widget, WidgetValues} from "webviz/panels/plugin_widgets.js" */

export function install() {
  installChooser();
  watch("panels", (values, changed) => {
    if (changed.has("/types")) types.value = [...values.get("/types")];
    added.value = values.get("/order").map((name) => ({
      name: `plugin-${name}`,
      title: values.get(name) ?? name,
      open: (/** @type {HTMLElement} */ element, /** @type {HTMLElement} */ head) =>
        open(element, head, name),
      remove: () => remove(name),
    }));
  });
  watch("modules", (modules, changed) => {
    for (const name of changed) {
      const texts = modules.get(name);
      if (texts) start(name, Object.entries(texts));
    }
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

const NOT_LOADED =
  "Not removed: this panel is not loaded. Repair its plug-in, or take it out of the config.";
const LOOKED_AT = new Set(["area", "chart"]); // what a chart lets people change has its own locks

/**
 * @param {HTMLElement} element
 * @param {HTMLElement} head
 * @param {string} name
 */
function open(element, head, name) {
  const values = store(`panel:${name}`);
  const text = () => values.get("/failure") ?? "";
  const failure = el(
    "div",
    { class: "wv-plugin-failure", role: "alert", hidden: () => !text(), "data-level": "error" },
    text,
  );
  const widgets = signal(/** @type {Widget[]} */ ([]));
  const place = el("div", { class: "wv-plugin-widgets" }, () =>
    widgets.value.flatMap((widget) => widget.element ?? []),
  );
  const gear = settingsButton(name);
  const content = el("div", { class: "wv-plugin" }, failure, place);
  element.append(content);
  head.append(gear);
  /** @type {Map<string, Widget & {kind: string}>} */
  const widgetsById = new Map();
  takeFields(content, () => [...widgetsById.values()].find(({ drop }) => drop)?.drop);

  const end = watch(`panel:${name}`, (values, changed) => {
    const order = values.get("/order") ?? [];
    for (const id of order) draw(name, id, values, changed, widgetsById);
    widgets.value = order.flatMap((id) => widgetsById.get(id) ?? []);
    setChildren(head, [...widgets.value.flatMap((widget) => widget.head ?? []), gear]);
  });
  return () => {
    end();
    for (const widget of widgetsById.values()) widget.close?.();
  };
}

/**
 * @param {string} name of the panel
 * @param {string} id of the widget
 * @param {ValuesOf<"panel">} values
 * @param {Set<string>} changed
 * @param {Map<string, Widget & {kind: string}>} widgetsById
 */
function draw(name, id, values, changed, widgetsById) {
  const widget = /** @type {WidgetValues & {kind: string}} */ (values.get(id));
  const before = widgetsById.get(id);
  if (before?.kind === widget.kind) {
    const isChanged = changed.has(id) || [...changed].some((key) => key.startsWith(`${id}/`));
    if (isChanged) before.update(widget, values, id);
    return;
  }
  // A panel that was loaded again may have another widget under the same id.
  before?.close?.();
  const instance = makeWidget(widget, (value) =>
    act("UseWidget", { panel: name, widget: id, value }),
  );
  widgetsById.set(id, instance);
  instance.update(widget, values, id);
  if (LOOKED_AT.has(widget.kind)) return;
  for (const part of [instance.element, instance.head]) if (part) needs("UseWidget", part);
}

/**
 * The button that opens the properties of a panel, hidden if it has none.
 *
 * @param {string} name
 */
function settingsButton(name) {
  const values = store(`panel_properties:${name}`);
  /** @type {SendProperty} */
  const send = (path, value) =>
    act(
      "SetPanelProperty",
      { panel: values.get("id") ?? "", path, value },
      { quiet: true, errors: "caller" },
    );
  const options = { values, send, command: "SetPanelProperty" };
  const fields = () =>
    declaredForm(values, (declared) =>
      form(declared, { ...options, name: `panel.${values.get("type")}` }),
    );
  return popoverButton(
    "gear",
    "Settings of this panel",
    () => [el("h3", {}, "Settings"), el("div", {}, fields())],
    {
      hidden: () => !values.get("declared")?.length,
    },
  );
}

/** @param {string} name */
async function remove(name) {
  const panel = await once(`panel_properties:${name}`, (values) => values.get("id"));
  if (!panel) return void toast(NOT_LOADED, { level: "warn" });
  const { level, text } = await act("RemovePanel", { panel }, { quiet: true });
  if (level === "ok")
    toast(text, { action: { label: "Undo", run: () => act("Undo", { own: true }) } });
}
