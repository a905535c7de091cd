// The panel "Views": what this browser looks at, and the views that are saved for all.

import { act } from "../act.js";
import * as channel from "../channel.js";
import { form } from "../controls/form.js";
import { FIXED_FRAME } from "../controls/frame.js";
import { el } from "../dom.js";
import { iconButton } from "../icons.js";
import { openMenuBelow } from "../shell/menu.js";
import { watch } from "../stores.js";
import { maker } from "./displays/properties.js";
import { savedViews } from "./saved_views.js";

/** @import {DeclaredProperty} from "../contents.js" */
/** @import {MenuItem} from "../shell/menu.js" */
/** @import {Panel} from "../types.js" */

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

/** @type {() => void} */
let watchAgain = () => {};
// viser gives the page another id when it connects again.
channel.onOpen(() => watchAgain());

/** @type {Panel} */
export const views = {
  name: "views",
  title: "Views",
  order: 20,
  open(element) {
    /** @type {() => void} */
    let endView = () => {};
    /** @type {ReturnType<typeof form> | null} */
    let head = null;
    /**
     * @param {string} key
     * @param {unknown} value
     */
    const send = (key, value) =>
      act("ChangeView", { key, value }, { quiet: true, errors: "caller" });
    const options = { send, name: "view", marks: false };
    const [common, own] = [el("div"), el("div")];
    const numbers = maker(own, (declared) =>
      form(
        declared.filter(({ path }) => path !== TARGET.path),
        options,
      ),
    );
    const saved = savedViews();
    element.append(
      el(
        "section",
        { class: "wv-view", "aria-label": "Current view" },
        el(
          "div",
          { class: "wv-view-head" },
          el("h2", { class: "wv-view-title" }, "Current view"),
          buttons(),
        ),
        common,
        own,
      ),
      saved.element,
    );
    watchAgain = () => {
      endView();
      endView = watch(`view:${window.webviz.browser}`, (values, changed) => {
        if (!values.has("declared")) return;
        if (!head) {
          head = form([{ ...TYPE, choices: values.get("types") }, TARGET], options);
          common.append(head.element);
        }
        head.update(values, changed);
        numbers.update(values, changed);
      });
    };
    if (channel.isOpen()) watchAgain();
    const end = watch("views", (values) => saved.update(values.get("saved")));
    return () => {
      end();
      endView();
      numbers.end();
      watchAgain = () => {};
    };
  },
};

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
