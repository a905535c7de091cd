// The list of commands (Ctrl+K): everything that can be done, found by its name.

import { why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { textField } from "webviz/controls/fields.js";
import { el } from "webviz/dom.js";
import { watch } from "webviz/stores.js";
import { all, keysOf, run } from "webviz/commands.js";
import { openDialog } from "webviz/controls/dialog.js";
import { FIXED, follow } from "webviz/shell/follow.js";
import { OptionList, search } from "webviz/controls/option_list.js";

/** @import {Command} from "webviz/commands.js" */
/** @import {StoreName, ValuesOf} from "webviz/types.js" */

/**
 * @typedef {{[K in StoreName]?: ValuesOf<K>}} Values
 * @typedef {{stores: StoreName[], make(values: Values): Command[]}} Maker
 */

const MAX_SHOWN = 100;
const ORDER = ["Edit", "Displays", "Tools", "View", "File", "Time", "Help"];
/** @type {StoreName[]} */
const STORES = ["settings", "frames"];

/** @type {Set<Maker>} */
const factories = new Set();

/**
 * Adds commands that are looked for in the list only, made of the values of stores by their names:
 * `make({displays: Map, ...})`. `stores` are watched while the list is open.
 *
 * @template {StoreName} N
 * @param {N[]} stores
 * @param {(values: {[K in N]: ValuesOf<K>}) => Command[]} make
 */
export function provideFrom(stores, make) {
  factories.add({ stores, make: /** @type {Maker["make"]} */ (make) });
}

export function openCommandList() {
  if (document.querySelector(".wv-command-list[open]")) return;
  const input = textField("Command", {
    class: "wv-field wv-search",
    placeholder: "Type a command",
  });
  /** @type {Values} */
  const values = {};
  const stores = new Set([...STORES, ...[...factories].flatMap((maker) => maker.stores)]);
  /** @type {(() => void)[]} */
  const ends = [];
  const nothing = el("p", { class: "wv-quiet wv-nothing", hidden: true }, "No matching commands.");

  openDialog({
    title: "Commands",
    className: "wv-command-list",
    isLight: true,
    content(close) {
      const list = new OptionList(input, "Commands", (row) => close(matches[Number(row.id)]));
      /** @type {Command[]} */
      let matches = [];
      const show = () => {
        matches = search(commands(values), input.value, ({ name, group }) => [name, group ?? ""]);
        matches.length = Math.min(matches.length, MAX_SHOWN);
        list.show(
          matches.map((one, id) => ({
            id,
            title: one.name,
            icon: one.icon ?? "chevron",
            note: one.note,
            key: keysOf(one)[0],
            ...lockOf(one),
            group: input.value.trim() ? undefined : { title: one.group },
          })),
        );
        nothing.hidden = matches.length > 0;
      };
      for (const name of stores) {
        ends.push(
          watch(name, (store) => {
            Object.assign(values, { [name]: store });
            show();
          }),
        );
      }
      input.addEventListener("input", show);
      show();
      return [input, list.element, nothing];
    },
  }).then((chosen) => {
    ends.forEach((end) => end());
    if (chosen) run(chosen);
  });
}

/** @param {Command} command */
const lockOf = ({ needs }) => {
  const refusal = needs ? why(needs) : "";
  return { disabled: refusal !== "", refusal };
};

/**
 * @param {Values} values
 * @returns {Command[]}
 */
function commands(values) {
  const { settings, frames } = values;
  const more = [...factories].flatMap(({ stores, make }) =>
    stores.every((name) => values[name]) ? make(values) : [],
  );
  /** @param {Command} command */
  const place = ({ group }) => (ORDER.indexOf(group ?? "") + ORDER.length) % ORDER.length;
  return [
    ...all()
      .filter(({ isHidden }) => !isHidden)
      .sort((a, b) => place(a) - place(b)),
    ...more,
    ...(frames?.get("frames") ?? []).map((frame) => ({
      name: `Fixed frame: ${frame}`,
      icon: "axes",
      group: "Fixed frame",
      note: frame === settings?.get("fixed_frame") ? "now" : "",
      needs: "SetFixedFrame",
      run: () => act("SetFixedFrame", { frame }),
    })),
    ...(frames?.get("frames") ?? []).map((frame) => ({
      name: `Follow ${frame}`,
      icon: "follow",
      group: "Follow",
      run: () => follow(frame),
    })),
    { name: "Follow nothing", icon: "follow", group: "Follow", run: () => follow(FIXED) },
  ];
}
