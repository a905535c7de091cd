// The panel "Tools": what this page has sent, and RViz's Tool Properties.

import { act } from "webviz/act.js";
import { copyAndTell } from "webviz/clipboard.js";
import { declaredForm, form } from "webviz/controls/form.js";
import { disclosure } from "webviz/controls/disclosure.js";
import { permission } from "webviz/controls/permission.js";
import { el } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { ask } from "webviz/controls/dialog.js";
import { each, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { showHint, showLiveHint } from "webviz/tools/hint.js";
import * as history from "webviz/features/tools/history.js";
import { fixed } from "webviz/numbers.js";
import * as registry from "webviz/tools/registry.js";
import * as preview from "webviz/tools/preview.js";
import { timeOfDay } from "webviz/time_text.js";
import { yaml } from "webviz/tools/yaml.js";

/** @import {Panel, SendProperty} from "webviz/types.js" */
/** @import {SentGesture} from "webviz/features/tools/history.js" */

/** @param {Date} time */
const clock = (time) =>
  timeOfDay(time.getTime() / 1000)
    .split(" ")
    .at(-1) ?? "";
const NONE = "Nothing sent from this page yet. Choose a tool over the scene.";

/** @type {Panel} */
export const toolsPanel = {
  name: "tools",
  title: "Tools",
  order: 50,
  open(element) {
    const rows = each(
      history.all,
      ({ number }) => number,
      (entry) => sentRow(() => entry.value),
    );
    element.append(
      el("h3", { class: "wv-tools-head" }, "Sent from this page"),
      el("p", { class: "wv-sent-none", hidden: () => history.all().length > 0 }, NONE),
      el("ol", { class: "wv-sent", "aria-label": "Sent from this page" }, rows),
      el("h3", { class: "wv-tools-head" }, "Properties"),
      el("div", {}, sections()),
    );
    return () => element.replaceChildren();
  },
};

/** @param {() => SentGesture} entry */
function sentRow(entry) {
  const place = () => {
    const { points, yaw, tool, several, frame } = entry();
    const [x, y, z] = points[0].map((number) => fixed(number, 2));
    const heading = `yaw ${fixed((yaw * 180) / Math.PI, 1)}°`;
    const where = [`x ${x} y ${y} z ${z}`, tool.gesture === "pose" && heading];
    const parts = several ? [`${points.length} waypoints`, several] : where;
    return [...parts, frame].filter(Boolean).join(" · ");
  };
  const head = () => `${entry().tool.name} · ${clock(entry().time)}`;
  return el(
    "li",
    { "data-level": () => entry().level || null },
    el(
      "div",
      { class: "wv-sent-text" },
      el("span", { class: "wv-sent-head" }, head),
      el("span", { class: "wv-sent-place" }, place),
      el("span", { class: "wv-sent-result" }, () => entry().text || "No result yet."),
    ),
    iconButton("refresh", "Send again", () => sendAgain(entry())),
    iconButton("copy", "Copy as YAML", () => copyYaml(entry()), {
      hidden: () => !entry().messages.length,
    }),
  );
}

/**
 * As with the gesture itself: where the tool asks, its preview comes first.
 *
 * @param {SentGesture} entry
 */
async function sendAgain(entry) {
  const tool = registry.all().find(({ id }) => id === entry.tool.id);
  if (!tool)
    return showHint(
      "warn",
      `Not sent: the tool ${entry.tool.name} no longer exists. Choose another one.`,
    );
  const frame = `this was in ${entry.frame}. Choose it as the fixed frame.`;
  if (entry.frame !== history.fixedFrame()) return showHint("warn", `Not sent: ${frame}`);
  if (tool.refusal) return showHint("warn", tool.refusal);
  if (!tool.asks) return history.again(entry);
  if (entry.several) {
    const question = `Send the ${entry.points.length} waypoints again?`;
    return (await ask(question, { confirm: "Send" })) && history.again(entry);
  }
  registry.select(tool);
  const onEnd = () => {
    if (!registry.active()?.stays) registry.select(null);
    history.again(entry);
  };
  preview.propose(tool, entry, { onEnd, live: showLiveHint });
}

/** @param {SentGesture} entry */
function copyYaml({ messages }) {
  const texts = messages.map(
    ({ topic, type, values }) => `# ${topic}: ${type}\n${yaml(/** @type {object} */ (values))}`,
  );
  copyAndTell(texts.join("---\n"), "Copied as YAML.");
}

/** One section per tool of the viewer; those of the page have no properties. */
const sections = () =>
  each(
    () => registry.all().filter(({ gesture }) => gesture),
    ({ id }) => id,
    (tool, id) =>
      disclosure(
        el("span", {}, () => tool.value.name),
        () => el("div", {}, rights(id), el("div", {}, properties(id))),
        { class: "wv-tool-properties" },
        signal(true),
      ),
  );

/**
 * The right to each name that a tool sends to.
 *
 * @param {string} tool
 */
function rights(tool) {
  const values = store(`tool:${tool}`);
  const notices = each(
    () => new Set(values.get("sends") ?? []),
    (name) => name,
    (_, name) => permission({ name: () => name, use: () => `publish on ${name}` }).element,
  );
  return el("div", { class: "wv-tool-rights" }, notices);
}

/** @param {string} tool */
function properties(tool) {
  const values = store(`tool:${tool}`);
  /** @type {SendProperty} */
  const send = (path, value) =>
    act("SetToolProperty", { tool, path, value }, { quiet: true, errors: "caller" });
  const options = { values, send, command: "SetToolProperty" };
  return declaredForm(values, (declared) =>
    form(declared, { ...options, name: `tool.${values.get("type")}` }),
  );
}
