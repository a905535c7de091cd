// Adds fields of messages to the panel Plot.

import { act } from "webviz/act.js";
import { toast } from "webviz/toasts.js";
import { messagePath } from "webviz/panels/field_drag.js";
import { once } from "webviz/stores.js";

const TYPE = "Plot";

/**
 * Plots a field: in the first panel of that kind, or in a new one.
 *
 * @param {string} topic
 * @param {string} path
 */
export async function plotField(topic, path) {
  const curve = messagePath({ topic, path });
  const { id, curves } = await firstPlot();
  if (curves?.includes(curve)) return toast(`${curve} is plotted already.`);
  const { level } = await (id
    ? act(
        "SetPanelProperty",
        { panel: id, path: "curves", value: [...(curves ?? []), curve] },
        { quiet: true },
      )
    : act("AddPanel", { type: TYPE, values: { curves: [curve] } }, { quiet: true }));
  if (level === "ok") toast(`Added ${curve} to the panel Plot.`);
}

/** @returns {Promise<{id?: string, curves?: string[]}>} */
async function firstPlot() {
  const order = await once("panels", (values) => values.get("/order"));
  if (!order.includes(TYPE)) return {};
  return once(`panel_properties:${TYPE}`, (values) => ({
    id: values.get("id"),
    curves: /** @type {string[]} */ (values.get("value.curves")),
  }));
}
