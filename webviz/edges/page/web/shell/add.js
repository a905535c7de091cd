// The dialog that adds displays: by type, or for topics that are published just now.

import { act, newStep } from "../act.js";
import { el, set, setText } from "../dom.js";
import { recall, remember } from "../remember.js";
import { watch } from "../stores.js";
import { openDialog } from "./dialog.js";
import { optionList, search } from "./option_list.js";
import { typeIcon } from "./type_icons.js";

const MAX_SHOWN = 200;
const ANY = "any type";
const WAYS = { type: "By type", topic: "By topic" };

/** Opens the dialog; what is chosen goes to the end of the list, or of a group with this id. */
export function openAdd({ group = "" } = {}) {
  if (document.querySelector(".wv-add[open]")) return;
  const state = { way: recall("add", "type"), types: null, topics: null, traffic: null, shown: null };
  const checked = new Map();
  const input = el("input", {
    class: "wv-field wv-search",
    type: "text",
    "aria-label": "Search",
    placeholder: "Search",
  });
  const note = el("p", { class: "wv-quiet wv-nothing", hidden: true });
  let show = () => {};

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
        const { pick } = found.find(({ id }) => id === row.id);
        if (state.way === "type") return close([pick]);
        if (event.type === "click") {
          if (!checked.delete(row.id)) checked.set(row.id, pick);
          return show();
        }
        return close(checked.size ? [...checked.values()] : [pick]);
      });
      let found = [];
      show = () => {
        for (const tab of tabs) {
          const isShown = tab.dataset.way === state.way;
          set(tab, { "aria-selected": String(isShown) });
        }
        const all = rows(state, checked);
        found = search(all, input.value, ({ title, line, note: more }) => [
          title,
          `${line} ${more}`,
        ]);
        list.show(found.slice(0, MAX_SHOWN).map(({ pick: _, ...row }) => row));
        setText(note, remark(state, all, found.length));
        note.hidden = note.textContent === "";
        const button = input.closest("dialog")?.querySelector(".wv-primary");
        if (button) setText(button, checked.size > 1 ? `Add ${checked.size} displays` : "Add");
      };
      input.addEventListener("input", () => show());
      show();
      input.taken = () => {
        const active = found.find(({ id, disabled }) => !disabled && id === list.active());
        return checked.size ? [...checked.values()] : active ? [active.pick] : null;
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
      { label: "Add", value: "add", primary: true, accept: () => input.taken() !== null },
    ],
  }).then((chosen) => {
    ends.forEach((end) => end());
    const picks = chosen === "add" ? input.taken() : chosen;
    const step = newStep();
    for (const { type, values } of picks ?? []) act("AddDisplay", { type, values, group }, { step });
  });
}

function rows({ way, types, topics, traffic, shown }, checked) {
  if (way === "type") {
    return (types ?? []).map(([name, { help, topics: takes, picture }]) => ({
      id: name,
      title: name,
      icon: typeIcon(name),
      picture,
      line: help,
      note: takes.join(", "),
      pick: { type: name, values: {} },
    }));
  }
  const isShown = (topic) => shown?.has(topic) ?? false;
  const all = topics ?? [];
  const plain = new Set((types ?? []).filter(([, { topics }]) => topics.includes(ANY)).map(([name]) => name));
  const isPlain = (show) => show.every(([display]) => plain.has(display));
  const rank = ([topic, { show }]) => (show.length ? Number(isShown(topic)) + 2 * isPlain(show) : 4);
  const sorted = all.toSorted((a, b) => rank(a) - rank(b));
  return sorted.flatMap(([topic, offer]) => {
    const about = { title: topic, note: noteOf(offer, traffic?.get(topic), isShown(topic)) };
    if (!offer.show.length) {
      return [
        {
          ...about,
          id: topic,
          icon: "file",
          line: offer.why,
          disabled: true,
          group: "Not shown by any display",
        },
      ];
    }
    return offer.show.map(([display, values]) => ({
      ...about,
      id: `${topic} ${display}`,
      icon: typeIcon(display),
      line: `${display} · ${offer.types.join(", ")}`,
      group: isPlain(offer.show) ? "Shown as text only" : undefined,
      checked: checked.has(`${topic} ${display}`),
      pick: { type: display, values },
    }));
  });
}

function noteOf({ nodes }, traffic, isShown) {
  const rate = traffic?.hz ? `${Number(traffic.hz.toPrecision(2))} Hz` : "";
  const publishers = `${nodes.length} publisher${nodes.length === 1 ? "" : "s"}`;
  return [isShown ? "already shown" : "", rate, publishers].filter(Boolean).join(" · ");
}

const absolute = (topic) => (topic.startsWith("/") ? topic : `/${topic}`);

function remark({ way, types, topics }, all, count) {
  if ((way === "type" ? types : topics) === null) return "Loading…";
  if (!all.length) {
    return "No topic is published. Start the robot, a simulator or a bag; topics appear by themselves.";
  }
  if (!count) return "Nothing with these words.";
  return count > MAX_SHOWN ? `… and ${count - MAX_SHOWN} more: type a part of the name.` : "";
}
