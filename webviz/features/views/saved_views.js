// The saved views: show, rename and remove them, let browsers begin with one, save the current one.

import { needs, why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { textField } from "webviz/controls/fields.js";
import { el } from "webviz/dom.js";
import { icon, iconButton, textButton } from "webviz/icons.js";
import { each, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";

/** @import {Signal} from "webviz/signals.js" */
/** @import {SavedView} from "webviz/contents.js" */

const NAME = "View"; // of a view without a name, before its number

/** The list, and below it the field that saves. */
export function savedViews() {
  const views = store("views");
  const saved = () => views.get("saved") ?? [];
  const rows = each(
    saved,
    (view) => view.name,
    (view, name) => line(name, () => view.value),
  );
  const free = () => {
    const names = saved().map((view) => view.name);
    const numbers = Array.from({ length: names.length + 1 }, (_, at) => `${NAME} ${at + 1}`);
    return numbers.find((each) => !names.includes(each));
  };
  const name = textField("Name of the view to save", { placeholder: free });
  const save = el(
    "form",
    {
      class: "wv-saved-new",
      onsubmit(event) {
        event.preventDefault();
        act("SaveView", { name: name.value.trim() || name.placeholder });
        name.value = "";
      },
    },
    name,
    el("button", { type: "submit", class: "wv-button" }, icon("save"), "Save"),
  );
  const start = textButton("Start with this", () => act("StartWithView"), {
    tip: "Default view for new browsers and pictures",
    icon: "flag",
  });
  const isEmpty = () => views.isThere() && !saved().length;
  return el(
    "section",
    { class: "wv-view", "aria-label": "Saved views" },
    el("div", { class: "wv-view-head" }, el("h2", { class: "wv-view-title" }, "Saved views")),
    el("ul", { class: "wv-saved" }, rows),
    el(
      "p",
      { class: "wv-saved-none wv-quiet", hidden: () => !isEmpty() },
      "No views are saved yet.",
    ),
    needs("SaveView", save),
    needs("StartWithView", start),
  );
}

/**
 * @param {string} name
 * @param {() => SavedView} view
 */
function line(name, view) {
  const isRenamed = signal(false);
  const show = showButton(name, view, isRenamed, rename);
  const field = textField(`New name of ${name}`, {
    hidden: () => !isRenamed.value,
    onblur: take,
    onkeydown(event) {
      if (event.key !== "Enter" && event.key !== "Escape") return;
      event.stopPropagation();
      event.preventDefault(); // else it presses the button that gets the focus
      if (event.key === "Escape") field.value = name;
      show.hidden = false;
      show.focus(); // which takes what was typed
    },
  });

  function rename() {
    isRenamed.value = true;
    field.value = name;
    field.focus();
    field.select();
  }

  function take() {
    if (!isRenamed.value) return;
    isRenamed.value = false;
    const newName = field.value.trim();
    if (newName && newName !== name) act("RenameView", { name, new_name: newName });
  }

  const start = () => act("StartWithView", { view: name });
  const remove = () => act("RemoveView", { name });
  return el(
    "li",
    { class: "wv-saved-line" },
    show,
    field,
    needs("StartWithView", tool("flag", `Start with ${name}`, start)),
    needs("RenameView", tool("pencil", `Rename ${name}`, rename)),
    needs("RemoveView", tool("trash", `Remove ${name}`, remove)),
  );
}

/**
 * @param {string} name
 * @param {() => SavedView} view
 * @param {Signal<boolean>} hidden
 * @param {() => void} rename
 */
const showButton = (name, view, hidden, rename) =>
  el(
    "button",
    {
      type: "button",
      class: "wv-saved-show",
      "aria-label": name,
      title: `Show ${name}`,
      hidden,
      onclick: () => act("ShowView", { view: name }),
      onkeydown: ({ key }) => key === "F2" && !why("RenameView") && rename(),
    },
    el("span", { class: "wv-saved-name" }, name),
    el("span", { class: "wv-quiet" }, () => view().type),
    el(
      "span",
      {
        class: "wv-saved-start",
        title: "Browsers begin with it",
        hidden: () => !view().is_start,
      },
      icon("flag", 12),
    ),
  );

/**
 * @param {string} iconName
 * @param {string} tip
 * @param {() => unknown} run
 */
function tool(iconName, tip, run) {
  return iconButton(iconName, tip, run, { size: 14 });
}
