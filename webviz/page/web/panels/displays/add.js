// The dialog that adds displays: for topics that are published just now, or by type.

import { act, newStep } from "webviz/act.js";
import { textField } from "webviz/controls/fields.js";
import { el } from "webviz/dom.js";
import { recall, remember } from "webviz/remember.js";
import { computed, effect, root, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { openDialog } from "webviz/controls/dialog.js";
import { OptionList, search } from "webviz/controls/option_list.js";
import { topicEntries } from "webviz/panels/displays/topic_entries.js";

/** @import {Close} from "webviz/controls/dialog.js" */
/** @import {Signal} from "webviz/signals.js" */
/** @import {AddRow, Choice, Entry, StoreContents} from "webviz/panels/displays/topic_entries.js" */

const MAX_SHOWN = 200;
const WAYS = { topic: "By topic", type: "By display" };

/**
 * Opens the dialog; what is chosen goes to the end of the list, or of a group with this id.
 *
 * @param {{group?: string}} [options]
 */
export function openAdd({ group = "" } = {}) {
  if (document.querySelector(".wv-add[open]")) return;
  root(async (end) => {
    const way = signal(recall("add", "topic"));
    const checked = signal(/** @type {Map<string, Choice>} */ (new Map()));
    /** @type {() => Choice[] | null} */
    let choices = () => null; // what Add would add
    const chosen = await openDialog({
      title: "Add display",
      className: "wv-add",
      content(close) {
        const { content, choices: own } = chooser(way, checked, close);
        choices = own;
        return content;
      },
      buttons: [
        { label: "Cancel", value: null },
        {
          label: () => (checked.value.size > 1 ? `Add ${checked.value.size} displays` : "Add"),
          value: "add",
          primary: true,
          accept: () => choices() !== null,
        },
      ],
    });
    const picks = chosen === "add" ? choices() : chosen;
    end();
    const step = newStep();
    for (const { type, values } of picks ?? [])
      act("AddDisplay", { type, values, group }, { step });
  });
}

/**
 * @param {Signal<string>} way
 * @param {Signal<Map<string, Choice>>} checked
 * @param {Close} close
 */
function chooser(way, checked, close) {
  const text = signal("");
  const facts = computed(knownNow);
  const all = computed(() =>
    way.value === "type" ? typeEntries(facts.value) : topicEntries(facts.value, checked.value),
  );
  const results = computed(() => matches(all.value, text.value));
  const input = textField("Search", { class: "wv-field wv-search", placeholder: "Search" });
  const list = new OptionList(input, "Displays", ({ id: row }, event) => {
    const { id, pick } = results.value.find((one) => one.id === row) ?? {};
    if (!id || !pick) return;
    if (way.value === "type") return close([pick]);
    const isToggled = event.type === "click" && event.detail < 2;
    const next = new Map(checked.value);
    if (isToggled && next.delete(id)) checked.value = next;
    else if (event.type === "click" || !next.size) checked.value = next.set(id, pick);
    if (!isToggled) close([...checked.value.values()]);
  });
  // After that of the list, which then begins with the best match.
  input.addEventListener("input", () => (text.value = input.value));
  effect(() => list.show(results.value.slice(0, MAX_SHOWN).map(({ pick: _, ...row }) => row)));
  const note = () => remark({ ...facts.value, way: way.value }, all.value, results.value.length);
  const tabs = Object.entries(WAYS).map(([name, label]) =>
    el(
      "button",
      {
        type: "button",
        class: "wv-tab",
        role: "tab",
        "data-way": name,
        "aria-selected": () => String(way.value === name),
        onclick() {
          remember("add", (way.value = name));
          input.focus();
        },
      },
      label,
    ),
  );
  const content = [
    input,
    el("div", { class: "wv-tabs", role: "tablist", "aria-label": "Add" }, tabs),
    list.element,
    el("p", { class: "wv-quiet wv-nothing", hidden: () => !note() }, note),
  ];
  const choices = () => {
    if (checked.value.size) return [...checked.value.values()];
    const active = results.value.find(({ id, disabled }) => !disabled && id === list.active());
    return active?.pick ? [active.pick] : null;
  };
  return { content, choices };
}

/**
 * Everything there is to choose from, null before it is known.
 *
 * @returns {StoreContents}
 */
function knownNow() {
  const [types, topics, traffic] = [store("types"), store("topics"), store("traffic")];
  const displays = store("displays");
  const names = [...displays.all().values()].flatMap((display) => display.topics ?? []);
  return {
    types: types.isThere() ? [...types.all()] : null,
    topics: topics.isThere() ? [...topics.all()].sort(([a], [b]) => (a < b ? -1 : 1)) : null,
    traffic: traffic.isThere() ? traffic.all() : null,
    displayedTopics: displays.isThere() ? new Set(names.map(absolute)) : null,
  };
}

/**
 * The rows that fit a text.
 *
 * @param {Entry[]} entries
 * @param {string} text
 * @returns {AddRow[]}
 */
const matches = (entries, text) =>
  search(entries, text, ({ words }) => words).flatMap(({ words, rows }) => {
    const narrow = search(rows, text, ({ title, note }) => [words[0], `${title} ${note}`]);
    return narrow.length ? narrow : rows;
  });

/**
 * @param {Pick<StoreContents, "types">} known
 * @returns {Entry[]}
 */
function typeEntries({ types }) {
  return (types ?? []).map(([name, { help, topics: takes, icon, picture }]) => ({
    words: [name, `${help} ${takes.join(", ")}`],
    rows: [
      {
        id: name,
        title: name,
        icon,
        picture,
        line: help,
        note: takes.join(", "),
        pick: { type: name, values: {} },
      },
    ],
  }));
}

/** @param {string} topic */
const absolute = (topic) => (topic.startsWith("/") ? topic : `/${topic}`);

/**
 * @param {StoreContents & {way: string}} known
 * @param {Entry[]} all
 * @param {number} count
 */
function remark({ way, types, topics }, all, count) {
  if ((way === "type" ? types : topics) === null) return "Loading…";
  if (!all.length) {
    return "No topic is published. Start the robot, a simulator or a bag; topics appear by themselves.";
  }
  if (!count) return "No matches.";
  return count > MAX_SHOWN ? `… and ${count - MAX_SHOWN} more: type a part of the name.` : "";
}
