// Everything around the scene: the side with its tabs, the places over the scene, the bar below it.

import * as channel from "webviz/channel.js";
import { el } from "webviz/dom.js";
import * as docks from "webviz/docks/docks.js";
import * as dock from "webviz/images/dock.js";
import * as actions from "webviz/shell/actions.js";
import { keepKeysFree } from "webviz/shell/click_focus.js";
import * as commands from "webviz/commands.js";
import * as displayCommands from "webviz/shell/display_commands.js";
import * as drop from "webviz/shell/drop.js";
import * as firstRun from "webviz/shell/first_run.js";
import * as header from "webviz/shell/header.js";
import * as layout from "webviz/docks/layout.js";
import { keepTextStill } from "webviz/shell/text_drag.js";
import * as timeBar from "webviz/shell/time_bar.js";
import { tabs } from "webviz/shell/tabs.js";
import * as toasts from "webviz/toasts.js";
import * as tooltips from "webviz/shell/tooltips.js";
import * as viser from "webviz/viser_page.js";

/** Places for what lies over the scene and beside it; filled by the modules that they belong to. */
export const places = {
  scene: el("div", { class: "wv-over" }),
  toolbar: el("div", { class: "wv-top-left" }),
  status: el("div", { class: "wv-top-right" }),
  pointer: el("div", { class: "wv-bottom-left" }),
  legend: el("div", { class: "wv-bottom-right" }),
  cards: el("div", { class: "wv-stack" }),
  time: el("footer", { class: "wv-time" }),
};

export function install() {
  channel.on("Shell", ({ debug }) => {
    if (!document.getElementById("webviz")) build();
    document.body.classList.toggle("wv-debug", debug);
  });
}

function build() {
  commands.install();
  actions.install();
  displayCommands.install();
  const side = el("aside", { class: "wv-side", "aria-label": "Panels" });
  const { scene, time, ...corners } = places;
  scene.append(...Object.values(corners));
  timeBar.build(places.time);
  toasts.install(scene);
  keepKeysFree(places.time);
  keepKeysFree(places.toolbar);
  side.append(header.build(), ...tabs(), layout.border(side));
  const shade = el("div", { class: "wv-shade", onclick: () => layout.fold(true) });
  const page = el("div", { id: "webviz" }, scene, shade, side, places.time);
  docks.install(page);
  dock.install(page);
  document.body.append(page);
  document.body.classList.add("wv-on");
  viser.reveal();
  tooltips.install(page);
  drop.install(page);
  keepTextStill();
  firstRun.install(scene, places.cards);
  layout.install();
}
