// The panel "Tools": what this page has sent, and RViz's Tool Properties.

import { act } from "../../act.js";
import { copyAndTell } from "../../clipboard.js";
import { form } from "../../controls/form.js";
import { el, set, setChildren, setText } from "../../dom.js";
import { iconButton } from "../../icons.js";
import { ask } from "../../shell/dialog.js";
import { watch } from "../../stores.js";
import { tell, tellLive } from "../../tools/hint.js";
import * as history from "./history.js";
import { fixed } from "../../tools/numbers.js";
import * as registry from "../../tools/registry.js";
import * as preview from "../../tools/preview.js";
import { yaml } from "../../tools/yaml.js";
import { maker } from "../../panels/displays/properties.js";

/** @import {Panel} from "../../types.js" */
/** @import {SentGesture} from "./history.js" */

const NONE = "Nothing sent from this page yet. Choose a tool over the scene.";

/** @type {Panel} */
export const toolsPanel = {
  name: "tools",
  title: "Tools",
  order: 50,
  open(element) {
    const sent = el("ol", { class: "wv-sent", "aria-label": "Sent from this page" });
    const none = el("p", { class: "wv-sent-none" }, NONE);
    const sections = el("div");
    element.append(
      el("h3", { class: "wv-tools-head" }, "Sent from this page"),
      none,
      sent,
      el("h3", { class: "wv-tools-head" }, "Properties"),
      sections,
    );
    const endSent = showSent(sent, none);
    const endSections = showProperties(sections);
    return () => {
      endSent();
      endSections();
      element.replaceChildren();
    };
  },
};

/**
 * @param {HTMLElement} list
 * @param {HTMLElement} none
 */
function showSent(list, none) {
  /** @type {Map<number, ReturnType<typeof sentRow>>} */
  const rows = new Map();
  const update = () => {
    const entries = history.all();
    const known = new Set(entries.map(({ number }) => number));
    for (const number of rows.keys()) if (!known.has(number)) rows.delete(number);
    setChildren(
      list,
      entries.map((entry) => {
        const row = rows.get(entry.number) ?? sentRow();
        rows.set(entry.number, row);
        row.update(entry);
        return row.element;
      }),
    );
    none.hidden = entries.length > 0;
  };
  update();
  return history.onChange(update);
}

function sentRow() {
  /** @type {SentGesture | null} */
  let entry = null;
  const head = el("span", { class: "wv-sent-head" });
  const place = el("span", { class: "wv-sent-place" });
  const result = el("span", { class: "wv-sent-result" });
  const yamlButton = iconButton("copy", "Copy as YAML", () => entry && copyYaml(entry));
  const element = el(
    "li",
    {},
    el("div", { class: "wv-sent-text" }, head, place, result),
    iconButton("refresh", "Send again", () => entry && sendAgain(entry)),
    yamlButton,
  );
  return {
    element,
    /** @param {SentGesture} next */
    update(next) {
      entry = next;
      const [x, y, z] = next.points[0].map((number) => fixed(number, 2));
      const heading = `yaw ${fixed((next.yaw * 180) / Math.PI, 1)}°`;
      const isPose = next.tool.gesture === "pose";
      const where = [`x ${x} y ${y} z ${z}`, isPose && heading];
      const parts = next.several ? [`${next.points.length} waypoints`, next.several] : where;
      setText(head, `${next.tool.name} · ${next.time.toLocaleTimeString()}`);
      setText(place, [...parts, next.frame].filter(Boolean).join(" · "));
      setText(result, next.text || "No result yet.");
      set(element, { "data-level": next.level || null });
      if (yamlButton.hidden !== !next.messages.length) yamlButton.hidden = !next.messages.length;
    },
  };
}

/**
 * As with the gesture itself: where the tool asks, its preview comes first.
 *
 * @param {SentGesture} entry
 */
async function sendAgain(entry) {
  const tool = registry.all().find(({ id }) => id === entry.tool.id);
  if (!tool)
    return tell(
      "warn",
      `Not sent: the tool ${entry.tool.name} no longer exists. Choose another one.`,
    );
  const frame = `this was in ${entry.frame}. Choose it as the fixed frame.`;
  if (entry.frame !== history.fixedFrame()) return tell("warn", `Not sent: ${frame}`);
  if (tool.refusal) return tell("warn", tool.refusal);
  if (!tool.asks) return history.again(entry);
  if (entry.several) {
    const question = `Send the ${entry.points.length} waypoints again?`;
    return (await ask(question, { confirm: "Send" })) && history.again(entry);
  }
  registry.select(tool);
  const done = () => {
    if (!registry.active()?.stays) registry.select(null);
    history.again(entry);
  };
  preview.propose(tool, entry, { done, live: tellLive });
}

/** @param {SentGesture} entry */
function copyYaml({ messages }) {
  const texts = messages.map(
    ({ topic, type, values }) => `# ${topic}: ${type}\n${yaml(/** @type {object} */ (values))}`,
  );
  copyAndTell(texts.join("---\n"), "Copied as YAML.");
}

/**
 * One section per tool of the viewer; those of the page have no properties.
 *
 * @param {HTMLElement} place
 */
function showProperties(place) {
  /** @type {Map<string, ReturnType<typeof toolSection>>} */
  const shown = new Map();
  const update = () => {
    const tools = registry.all().filter(({ gesture }) => gesture);
    const ids = new Set(tools.map(({ id }) => id));
    for (const [id, section] of shown) {
      if (ids.has(id)) continue;
      section.end();
      shown.delete(id);
    }
    setChildren(
      place,
      tools.map(({ id, name }) => {
        const section = shown.get(id) ?? toolSection(id);
        shown.set(id, section);
        setText(section.title, name);
        return section.element;
      }),
    );
  };
  const end = registry.onChange(update);
  update();
  return () => {
    end();
    for (const section of shown.values()) section.end();
  };
}

/** @param {string} id */
function toolSection(id) {
  const title = el("summary");
  const content = el("div");
  /**
   * @param {string} path
   * @param {unknown} value
   */
  const send = (path, value) =>
    act("SetToolProperty", { tool: id, path, value }, { quiet: true, errors: "caller" });
  const made = maker(content, (declared, values) => {
    return form(declared, { send, name: `tool.${values.get("type")}`, command: "SetToolProperty" });
  });
  const end = watch(`tool:${id}`, made.update);
  return {
    title,
    element: el("details", { class: "wv-tool-properties", open: true }, title, content),
    end() {
      end();
      made.end();
    },
  };
}
