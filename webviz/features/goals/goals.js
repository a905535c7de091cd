// The goals that tools have sent: what every page shows of them; operators can cancel.

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { el, set, setChildren, setText } from "webviz/dom.js";
import { icon, iconButton, textButton } from "webviz/icons.js";
import { cards as places } from "webviz/shell/tools.js";
import { watch } from "webviz/stores.js";
import { makePoses } from "webviz/tools/poses.js";

/** @import {ValuesOf} from "webviz/types.js" */
/** @import {Pose} from "webviz/tools/poses.js" */
/** @import {Route, ShownGoal} from "webviz/contents.js" */

/** @type {Record<ShownGoal["phase"], string>} */
const TEXTS = { sending: "Sending…", active: "", canceling: "Cancelling…", ended: "" };

/** Shows a card for each goal. */
export function install() {
  const list = el("div", { class: "wv-goals", role: "region", "aria-label": "Goals" });
  /** @type {Map<string, ReturnType<typeof makeCard>>} */
  const cards = new Map();
  watch("goals", (goals) => {
    for (const id of cards.keys()) if (!goals.has(id)) cards.delete(id);
    for (const [id, goal] of goals) {
      if (!cards.has(id)) cards.set(id, makeCard(id));
      cards.get(id)?.update(goal);
    }
    setChildren(
      list,
      [...cards.values()].map(({ element }) => element),
    );
  });
  showRoutes();
  places.append(list);
}

// Show the poses to which robots drive, in the frame in which it was sent.
function showRoutes() {
  const show = makePoses("routes");
  /** @type {ValuesOf<"routes">} */
  let routes = new Map();
  /** @type {string | null} */
  let frame = null;
  const update = () =>
    show([...routes.values()].flatMap((route) => (route.frame === frame ? posesOf(route) : [])));
  watch("routes", (values) => {
    routes = values;
    update();
  });
  watch("settings", (settings) => {
    if (frame === settings.get("fixed_frame")) return;
    frame = settings.get("fixed_frame");
    update();
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

/** @param {string} id */
function makeCard(id) {
  const title = el("b");
  const label = el("span", { class: "wv-goal-label" });
  const dismiss = iconButton("close", "Dismiss", () => act("DismissGoal", { goal: id }));
  const values = el("dl", { class: "wv-goal-values" });
  const text = el("p", { class: "wv-goal-text", role: "status" });
  const cancel = textButton("Cancel", () => act("CancelGoal", { goal: id }));
  const head = el(
    "div",
    { class: "wv-goal-head" },
    icon("flag"),
    title,
    label,
    needs("DismissGoal", dismiss),
  );
  const element = el(
    "section",
    { class: "wv-card wv-goal" },
    head,
    values,
    text,
    needs("CancelGoal", cancel),
  );
  return {
    element,
    /** @param {ShownGoal} goal */
    update(goal) {
      set(element, {
        "data-level": goal.level || null,
        "aria-label": `${goal.title} ${goal.label}`,
      });
      setText(title, goal.title);
      setText(label, goal.label);
      setText(text, goal.text || TEXTS[goal.phase]);
      showValues(values, goal.values);
      const isEnded = goal.phase === "ended";
      /** @type {[HTMLElement, boolean][]} */
      const hiding = [
        [dismiss, !goal.can_dismiss],
        [cancel, isEnded],
        [text, !text.textContent],
        [values, !goal.values.length],
      ];
      for (const [part, isHidden] of hiding) {
        if (part.hidden !== isHidden) part.hidden = isHidden;
      }
      const isDisabled = goal.phase === "canceling";
      if (cancel.disabled !== isDisabled) cancel.disabled = isDisabled;
    },
  };
}

/**
 * @param {HTMLElement} list
 * @param {ShownGoal["values"]} values
 */
function showValues(list, values) {
  while (list.children.length > values.length) list.lastElementChild?.remove();
  while (list.children.length < values.length) list.append(el("div", {}, el("dt"), el("dd")));
  values.forEach(([label, text], index) => {
    const [term, value] = list.children[index].children;
    setText(term, label);
    setText(value, text);
  });
}
