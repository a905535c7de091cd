// Adds fields of messages to the panel Plot.

import { act } from "../act.js";
import { toast } from "../shell/toasts.js";
import { watch } from "../stores.js";

const TYPE = "Plot";

/** Plots a field: in the first panel of that kind, or in a new one. */
export async function plotField(topic, path) {
  const curve = `${topic.startsWith("/") ? "" : "/"}${topic}.${path}`;
  const { id, curves } = await firstPlot();
  if (curves?.includes(curve)) return toast(`${curve} is plotted already.`);
  const { level } = await (id
    ? act(
        "SetPanelProperty",
        { panel: id, path: "curves", value: [...curves, curve] },
        { quiet: true },
      )
    : act("AddPanel", { type: TYPE, values: { curves: [curve] } }, { quiet: true }));
  if (level === "ok") toast(`Added ${curve} to the panel Plot.`);
}

async function firstPlot() {
  const order = (await once("panels")).get("/order") ?? [];
  if (!order.includes(TYPE)) return {};
  const values = await once(`panel_properties:${TYPE}`);
  return { id: values.get("id"), curves: values.get("value.curves") };
}

// The present values of a store.
function once(store) {
  return new Promise((resolve) => {
    const end = watch(store, (values) => {
      resolve(new Map(values));
      queueMicrotask(() => end());
    });
  });
}
