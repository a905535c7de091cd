// Bags of this machine in the dialog "Open": they are played in the place of live topics.

import { act } from "webviz/act.js";
import { el } from "webviz/dom.js";
import { icon, textButton } from "webviz/icons.js";
import { filesSection } from "webviz/shell/opening.js";
import { each } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { timeOfDay } from "webviz/time_text.js";
import { install as installUpload } from "webviz/features/bags/upload.js";

/** @import {Close} from "webviz/controls/dialog.js" */
/** @import {Bag} from "webviz/contents.js" */
/** @import {Signal} from "webviz/signals.js" */

const NONE = "No bags yet. Start webviz with --library to name a folder that has some.";
const ALONE = "This viewer was started with a bag. Start it without one to open others here.";

export function install() {
  filesSection(section);
  installUpload();
}

/** @param {Close} close */
function section(close) {
  const values = store("bags");
  const bags = () => values.get("bags") ?? [];
  const note = () => (values.get("can_open") === false ? ALONE : bags().length ? "" : NONE);
  return [
    el("h3", {}, "Bags and reports"),
    el("p", { class: "wv-quiet", hidden: () => !note() || !values.isThere() }, note),
    el(
      "div",
      { class: "wv-files", role: "group", "aria-label": "Bags" },
      each(
        bags,
        ({ path }) => path,
        (item, path) =>
          el(
            "div",
            { class: "wv-bag-line" },
            row(item, () => close({ run: () => play(path) })),
            beside(() => close({ run: () => act("CompareRecording", { path }) })),
          ),
      ),
    ),
    el(
      "p",
      { class: "wv-bag-line", hidden: () => !values.get("second") },
      el("span", {}, () => `${values.get("second")} is shown beside ${values.get("opened")}.`),
      textButton("End comparison", () => close({ run: () => act("EndComparison", {}) })),
    ),
  ];
}

/**
 * The button that shows a bag beside the one that is open.
 *
 * @param {() => void} choose
 */
const beside = (choose) =>
  textButton("Compare", choose, {
    hidden: () => !store("bags").get("opened"),
    tip: () => `Show it beside ${store("bags").get("opened")}, tinted, on one timeline`,
  });

/** @param {string} path */
const play = (path) => act("OpenRecording", { path });

/**
 * @param {Signal<Bag>} item
 * @param {() => void} choose
 */
function row(item, choose) {
  const about = () => {
    const { megabytes, changed_s: changed } = item.value;
    // Beside a button, there is room for the name or the time.
    return store("bags").get("opened")
      ? `${megabytes} MB`
      : `${megabytes} MB · ${timeOfDay(changed)}`;
  };
  return el(
    "button",
    {
      type: "button",
      class: "wv-file-row wv-bag-row",
      disabled: () => store("bags").get("can_open") !== true,
      "data-tip": () => item.value.path,
      onclick: choose,
    },
    icon("play"),
    el("span", {}, () => item.value.name),
    el("span", { class: "wv-quiet" }, about),
  );
}
