// The dialog that adds displays: for topics that are published just now, or by type.

import { act, newStep } from "../../act.js";
import { textField } from "../../controls/fields.js";
import { el, set, setText, showText } from "../../dom.js";
import { recall, remember } from "../../remember.js";
import { watch } from "../../stores.js";
import { openDialog } from "../../controls/dialog.js";
import { optionList, search } from "../../controls/option_list.js";
import { topicEntries } from "./topic_entries.js";

/** @import {AddRow, Choice, Entry, Known} from "./topic_entries.js" */

const MAX_SHOWN = 200;
const WAYS = { topic: "By topic", type: "By display" };

/**
 * Opens the dialog; what is chosen goes to the end of the list, or of a group with this id.
 *
 * @param {{group?: string}} [options]
 */
export function openAdd({ group = "" } = {}) {
  if (document.querySelector(".wv-add[open]")) return;
  /** @type {Known & {way: string}} */
  const state = {
    way: recall("add", "topic"),
    types: null,
    topics: null,
    traffic: null,
    shown: null,
  };
  /** @type {Map<string, Choice>} */
  const checked = new Map();
  const input = textField("Search", { class: "wv-field wv-search", placeholder: "Search" });
  const note = el("p", { class: "wv-quiet wv-nothing", hidden: true });
  let show = () => {};
  /** @type {() => Choice[] | null} */
  let taken = () => null; // what Add would add

  const tabs = Object.entries(WAYS).map(([way, label]) =>
    el(
      "button",
      {
        type: "button",
        class: "wv-tab",
        role: "tab",
        "data-way": way,
        onclick: () => {
          state.way = way;
          remember("add", way);
          show();
          input.focus();
        },
      },
      label,
    ),
  );
  const ends = [
    watch("types", (types) => {
      state.types = [...types];
      show();
    }),
    watch("topics", (topics) => {
      state.topics = [...topics].sort(([a], [b]) => (a < b ? -1 : 1));
      show();
    }),
    watch("traffic", (traffic) => {
      state.traffic = traffic;
      show();
    }),
    watch("displays", (displays) => {
      const topics = [...displays.values()].flatMap((display) => display.topics ?? []);
      state.shown = new Set(topics.map(absolute));
      show();
    }),
  ];

  openDialog({
    title: "Add display",
    className: "wv-add",
    content(close) {
      const list = optionList(input, "Displays", (row, event) => {
        const { id, pick } = found.find((one) => one.id === row.id) ?? {};
        if (!id || !pick) return;
        if (state.way === "type") return close([pick]);
        if (event.type === "click" && event.detail < 2) {
          if (!checked.delete(id)) checked.set(id, pick);
          return show();
        }
        if (event.type === "click" || !checked.size) checked.set(id, pick);
        return close([...checked.values()]);
      });
      /** @type {AddRow[]} */
      let found = [];
      show = () => {
        for (const tab of tabs) {
          const isShown = tab.dataset.way === state.way;
          set(tab, { "aria-selected": String(isShown) });
        }
        const all = state.way === "type" ? typeEntries(state) : topicEntries(state, checked);
        found = search(all, input.value, ({ words }) => words).flatMap(({ words, rows }) => {
          const narrow = search(rows, input.value, ({ title, note: more }) => [
            words[0],
            `${title} ${more}`,
          ]);
          return narrow.length ? narrow : rows;
        });
        list.show(found.slice(0, MAX_SHOWN).map(({ pick: _, ...row }) => row));
        showText(note, remark(state, all, found.length));
        const button = input.closest("dialog")?.querySelector(".wv-primary");
        if (button) setText(button, checked.size > 1 ? `Add ${checked.size} displays` : "Add");
      };
      input.addEventListener("input", () => show());
      show();
      taken = () => {
        const active = found.find(({ id, disabled }) => !disabled && id === list.active());
        return checked.size ? [...checked.values()] : active?.pick ? [active.pick] : null;
      };
      return [
        input,
        el("div", { class: "wv-tabs", role: "tablist", "aria-label": "Add" }, tabs),
        list.element,
        note,
      ];
    },
    buttons: [
      { label: "Cancel", value: null },
      { label: "Add", value: "add", primary: true, accept: () => taken() !== null },
    ],
  }).then((chosen) => {
    ends.forEach((end) => end());
    const picks = chosen === "add" ? taken() : chosen;
    const step = newStep();
    for (const { type, values } of picks ?? [])
      act("AddDisplay", { type, values, group }, { step });
  });
}

/**
 * @param {Pick<Known, "types">} known
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
 * @param {Known & {way: string}} known
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
