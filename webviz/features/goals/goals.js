// The goals that tools have sent: what every page shows of them; operators can cancel.

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { el } from "webviz/dom.js";
import { icon, iconButton, textButton } from "webviz/icons.js";
import { cards as places } from "webviz/shell/tool_buttons.js";
import { computed, each, effect } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { makePoses } from "webviz/tools/poses.js";

/** @import {Pose} from "webviz/tools/poses.js" */
/** @import {Route, ShownGoal} from "webviz/contents.js" */

/** @type {Record<ShownGoal["phase"], string>} */
const TEXTS = { sending: "Sending…", active: "", canceling: "Cancelling…", ended: "" };

/** Shows a card for each goal. */
export function install() {
  const cards = each(
    () => store("goals").all(),
    ([id]) => id,
    (goal, id) => card(() => goal.value[1], id),
  );
  places.append(el("div", { class: "wv-goals", role: "region", "aria-label": "Goals" }, cards));
  showRoutes();
}

// Show the poses to which robots drive, in the frame in which it was sent.
function showRoutes() {
  const show = makePoses("routes");
  const frame = computed(() => store("settings").get("fixed_frame"));
  effect(() => {
    const routes = [...store("routes").all().values()].filter(
      (route) => route.frame === frame.value,
    );
    show(routes.flatMap(posesOf));
  });
}

/**
 * @param {Route} route
 * @returns {Pose[]}
 */
const posesOf = ({ poses }) =>
  poses.map(([x, y, z, yaw], index) => ({
    point: [x, y, z],
    yaw,
    number: poses.length > 1 ? String(index + 1) : "",
  }));

/**
 * @param {() => ShownGoal} goal
 * @param {string} id
 */
function card(goal, id) {
  const text = () => goal().text || TEXTS[goal().phase];
  const dismiss = iconButton("close", "Dismiss", () => act("DismissGoal", { goal: id }), {
    hidden: () => !goal().can_dismiss,
  });
  const cancel = textButton("Cancel", () => act("CancelGoal", { goal: id }), {
    hidden: () => goal().phase === "ended",
    disabled: () => goal().phase === "canceling",
  });
  return el(
    "section",
    {
      class: "wv-card wv-goal",
      "data-level": () => goal().level || null,
      "aria-label": () => `${goal().title} ${goal().label}`,
    },
    el(
      "div",
      { class: "wv-goal-head" },
      icon("flag"),
      el("b", {}, () => goal().title),
      el("span", { class: "wv-goal-label" }, () => goal().label),
      needs("DismissGoal", dismiss),
    ),
    valuesOf(() => goal().values),
    el("p", { class: "wv-goal-text", role: "status", hidden: () => !text() }, text),
    needs("CancelGoal", cancel),
  );
}

/** @param {() => ShownGoal["values"]} values */
function valuesOf(values) {
  const rows = each(
    () => values().map((pair, index) => ({ pair, index })),
    ({ index }) => index,
    (row) =>
      el(
        "div",
        {},
        el("dt", {}, () => row.value.pair[0]),
        el("dd", {}, () => row.value.pair[1]),
      ),
  );
  return el("dl", { class: "wv-goal-values", hidden: () => !values().length }, rows);
}
