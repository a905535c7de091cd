// The panels of plug-ins: what a Python program has recorded of widgets, drawn.

import { needs } from "../access.js";
import { act } from "../act.js";
import { form } from "../controls/form.js";
import { el, set, setChildren, setText } from "../dom.js";
import { provide } from "../shell/commands.js";
import { watch } from "../stores.js";
import { maker } from "./displays/properties.js";
import { makeWidget } from "./plugin_widgets.js";

/** @import {ValuesOf} from "../types.js" */

/** Calls `offer(panels)` with the panels of plug-ins whenever they change, `types(types)` likewise. */
export function followPlugins(offer, types) {
  watch("panels", (values, changed) => {
    if (changed.has("/types")) types(values.get("/types"));
    offer(
      values.get("/order").map((name) => ({
        name: `plugin-${name}`,
        title: values.get(name),
        open: (element) => open(element, name),
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

function open(element, name) {
  const failure = el("div", {
    class: "wv-plugin-failure",
    role: "alert",
    hidden: true,
    "data-level": "error",
  });
  const place = el("div", { class: "wv-plugin-widgets" });
  const [settings, endProperties] = properties(name);
  element.append(el("div", { class: "wv-plugin" }, failure, place), ...settings);
  const drawn = new Map();

  const end = watch(`panel:${name}`, (values, changed) => {
    const order = values.get("/order") ?? [];
    for (const id of order) {
      const widget = /** @type {{kind: string}} */ (values.get(id));
      // A panel that was loaded again may have another widget under the same id.
      if (drawn.get(id)?.kind !== widget.kind) {
        drawn.get(id)?.close?.();
        drawn.set(
          id,
          makeWidget(widget, (value) => act("UseWidget", { panel: name, widget: id, value })),
        );
        drawn.get(id).update(widget, values, id);
        if (!LOOKED_AT.has(widget.kind)) needs("UseWidget", drawn.get(id).element);
      } else if (changed.has(id) || [...changed].some((key) => key.startsWith(`${id}/`)))
        drawn.get(id).update(widget, values, id);
    }
    setChildren(
      place,
      order.map((id) => drawn.get(id).element),
    );
    const sentence = values.get("/failure") ?? "";
    setText(failure, sentence);
    set(failure, { hidden: !sentence });
  });
  return () => {
    end();
    endProperties();
    for (const widget of drawn.values()) widget.close?.();
  };
}

/**
 * The elements with the properties of a panel, and what ends them.
 *
 * @returns {[HTMLElement[], () => void]}
 */
function properties(name) {
  let id = "";
  const send = (path, value) =>
    act("SetPanelProperty", { panel: id, path, value }, { quiet: true, errors: "caller" });
  const place = el("div");
  const settings = el(
    "details",
    { class: "wv-tool-properties", hidden: true },
    el("summary", {}, "Properties"),
    place,
  );
  const remove = el(
    "button",
    {
      type: "button",
      class: "wv-plugin-remove",
      hidden: true,
      onclick: () => act("RemovePanel", { panel: id }),
    },
    "Remove panel",
  );
  needs("RemovePanel", remove);
  const made = maker(place, (declared, values) => {
    return form(declared, {
      send,
      name: `panel.${values.get("type")}`,
      command: "SetPanelProperty",
    });
  });
  const end = watch(`panel_properties:${name}`, (values, changed) => {
    id = values.get("id") ?? "";
    set(remove, { hidden: !id });
    set(settings, { hidden: !values.get("declared")?.length });
    if (id) made.update(values, changed);
  });
  return [
    [settings, remove],
    () => {
      end();
      made.end();
    },
  ];
}
