// The panel "Views": what this browser looks at, and the views that are saved for all.

import { act } from "webviz/act.js";
import { declaredForm, form } from "webviz/controls/form.js";
import { FIXED_FRAME } from "webviz/controls/frame.js";
import { el } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { openMenuBelow } from "webviz/controls/menu.js";
import { panel } from "webviz/panels/panels.js";
import { ownStore } from "webviz/own_store.js";
import { computed } from "webviz/signals.js";
import { watch } from "webviz/stores.js";
import { addMenu } from "webviz/features/views/menu.js";
import { savedViews } from "webviz/features/views/saved_views.js";

/** @import {DeclaredProperty} from "webviz/contents.js" */
/** @import {MenuItem} from "webviz/controls/menu.js" */
/** @import {Panel, SendProperty} from "webviz/types.js" */

/** @type {DeclaredProperty} */
const TYPE = {
  path: "type",
  label: "Type",
  kind: "choice",
  default: "Orbit",
  offered: false,
  help: "How the camera moves. Changing the type keeps the focal point.",
};
/** @type {DeclaredProperty} */
const TARGET = {
  path: "target_frame",
  label: "Target Frame",
  kind: "frame",
  default: FIXED_FRAME,
  offered: false,
  help: "The camera moves with this frame.",
};

/** @type {Panel} */
const views = {
  name: "views",
  title: "Views",
  order: 20,
  open(element) {
    const values = ownStore("view");
    /** @type {SendProperty} */
    const send = (key, value) =>
      act("ChangeView", { key, value }, { quiet: true, errors: "caller" });
    const options = { values, send, name: "view", marks: false };
    const types = computed(() => JSON.stringify(values.get("types") ?? null));
    const common = () => {
      const choices = JSON.parse(types.value);
      return choices && form([{ ...TYPE, choices }, TARGET], options);
    };
    const own = declaredForm(values, (declared) =>
      form(
        declared.filter(({ path }) => path !== TARGET.path),
        options,
      ),
    );
    const title = el("h2", { class: "wv-view-title" }, "Current view");
    element.append(
      el(
        "section",
        { class: "wv-view", "aria-label": "Current view" },
        el("div", { class: "wv-view-head" }, title, buttons()),
        el("div", {}, common),
        el("div", {}, own),
      ),
      savedViews(),
    );
  },
};

export function install() {
  panel(views);
  addMenu();
}

function buttons() {
  /** @type {HTMLButtonElement} */
  const focus = iconButton("focus", "Focus", () => openDisplays(focus), {
    tip: "Look at a display",
    "aria-haspopup": "menu",
  });
  const zero = iconButton("reset", "Zero", () => act("ResetView"), {
    tip: "Zero this view",
    "data-key": "z",
  });
  return [focus, zero];
}

/**
 * The displays as they are now.
 *
 * @param {HTMLElement} button
 */
function openDisplays(button) {
  const end = watch("displays", (rows) => {
    setTimeout(() => end()); // it may be called before there is an `end`
    /** @type {MenuItem[]} */
    const items = rows.get("order").map((display) => ({
      label: rows.get(display)?.name ?? display,
      run: () => act("FocusDisplay", { display }),
    }));
    openMenuBelow(button, items.length ? items : [{ label: "No displays", disabled: true }]);
  });
}
