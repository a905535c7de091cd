// The panel "Topics": all topics in a table, and the last message of the one that is chosen.

import { why } from "webviz/access.js";
import { openMenu } from "webviz/controls/menu.js";
import { el } from "webviz/dom.js";
import { icon, iconButton } from "webviz/icons.js";
import { recall, remember } from "webviz/remember.js";
import { rowList, touchable } from "webviz/controls/rows.js";
import { searchField } from "webviz/controls/fields.js";
import { panel } from "webviz/panels/panels.js";
import { computed, effect, signal, untracked } from "webviz/signals.js";
import { once, store } from "webviz/stores.js";
import { canvas } from "webviz/viser_page.js";
import { addDisplay, inspector } from "webviz/features/topics/topics_inspector.js";
import { takeFields } from "webviz/panels/field_drag.js";
import { toast } from "webviz/toasts.js";
import { isHiddenTopic } from "webviz/words.js";
import { arranged, tableHead, topicRow } from "webviz/panels/topics_table.js";

/** @import {Field} from "webviz/panels/field_drag.js" */
/** @import {Panel} from "webviz/types.js" */
/** @import {Sort} from "webviz/panels/topics_table.js" */

const WIDE_PX = 600;
const HEIGHTS = { wide: 26, narrow: 44 };
const NOTHING = "No topic is published. Start the robot, a simulator or a bag.";

export function install() {
  panel(topics);
  takeFields(canvas(), () => (why("AddDisplay") ? null : show));
}

const facts = store("topics");
const traffic = store("traffic");

/** @type {Panel} */
const topics = {
  name: "topics",
  title: "Topics",
  order: 30,
  open(element) {
    const topics = listed();
    const inspected = signal("");
    const { table, list } = grid(topics, (name) => (inspected.value = name));
    const dismiss = () => {
      inspected.value = "";
      table.focus();
    };
    /** @param {string} name */
    const inspect = (name) => {
      const topic = () => topics.all.value.find(({ key }) => key === name);
      return untracked(() => inspector(name, topic, dismiss));
    };
    const isEmpty = () => facts.isThere() && !topics.matches.value.length;
    /** @type {HTMLInputElement} */
    const search = searchField("Filter topics", () => (topics.text.value = search.value));
    const panel = el(
      "div",
      { class: "wv-topics" },
      el("div", { class: "wv-search" }, icon("search"), search, hiddenSwitch(topics)),
      table,
      el("div", { class: "wv-empty", role: "status", hidden: () => !isEmpty() }, () =>
        topics.all.value.length ? "No matching topics." : NOTHING,
      ),
      el("div", { class: "wv-topics-message" }, () =>
        inspected.value ? inspect(inspected.value) : null,
      ),
    );
    element.append(panel);
    const observer = new ResizeObserver(([{ contentRect }]) => {
      const isWide = contentRect.width >= WIDE_PX;
      panel.classList.toggle("wv-wide", isWide);
      list.resize(touchable(isWide ? HEIGHTS.wide : HEIGHTS.narrow));
    });
    observer.observe(panel);
    return () => observer.disconnect();
  },
};

/** Signals: all topics, and those that are found, by the text, the order and whether hidden ones count. */
function listed() {
  const sort = signal(/** @type {Sort} */ (recall("topics-sort", { column: "name", isUp: true })));
  effect(() => remember("topics-sort", sort.value));
  const isAll = signal(recall("topics-hidden", false));
  effect(() => remember("topics-hidden", isAll.value));
  const text = signal("");
  const all = computed(() => {
    const rates = traffic.all();
    return [...facts.all()].map(([key, topic]) => ({ key, ...topic, ...rates.get(key) }));
  });
  const hasHidden = computed(() => all.value.some(({ key }) => isHiddenTopic(key)));
  const offered = computed(() => all.value.filter(({ key }) => isAll.value || !isHiddenTopic(key)));
  const matches = computed(() => arranged(offered.value, text.value, sort.value));
  return { sort, isAll, text, all, hasHidden, matches };
}

/**
 * The table of topics.
 *
 * @param {ReturnType<typeof listed>} topics
 * @param {(name: string) => unknown} choose
 */
function grid({ sort, matches }, choose) {
  const table = el(
    "div",
    { class: "wv-topics-table", "aria-rowcount": () => matches.value.length + 1 },
    tableHead(sort),
  );
  const list = rowList({
    host: table,
    label: "Topics",
    role: "grid",
    rowRole: "row",
    height: HEIGHTS.narrow,
    row: topicRow,
    choose: ({ key }) => choose(key),
  });
  effect(() => list.show(matches.value));
  table.append(list.element);
  return { table, list };
}

/**
 * A button that lists hidden topics, too, where there are some.
 *
 * @param {Pick<ReturnType<typeof listed>, "isAll" | "hasHidden">} topics
 */
const hiddenSwitch = ({ isAll, hasHidden }) =>
  iconButton("eye", "Hidden topics", () => (isAll.value = !isAll.value), {
    tip: "Hidden topics, such as those of actions",
    "aria-pressed": () => String(isAll.value),
    hidden: () => !hasHidden.value,
  });

/**
 * Shows a topic that is dropped on the scene.
 *
 * @param {Field} field
 * @param {DragEvent} event
 */
async function show({ topic }, { clientX, clientY }) {
  const { show: fits = [], why: reason = "" } =
    (await once("topics", (all) => all.get(topic))) ?? {};
  if (!fits.length) return toast(reason || `No display shows ${topic}.`, { level: "warn" });
  addDisplay(topic, fits, (items) => openMenu(clientX, clientY, items));
}
