// The saved views: show, rename and remove them, let browsers begin with one, save the current one.

import { needs, why } from "../access.js";
import { act } from "../act.js";
import { textField } from "../controls/fields.js";
import { el, set, setChildren, setText } from "../dom.js";
import { icon, iconButton, textButton } from "../icons.js";

/** @import {SavedView} from "../contents.js" */

const NAME = "View"; // of a view without a name, before its number

/** The list, and below it the field that saves. Returns `{element, update(saved)}`. */
export function savedViews() {
  /** @type {Map<string, ReturnType<typeof line>>} */
  const lines = new Map();
  const list = el("ul", { class: "wv-saved" });
  const empty = el("p", { class: "wv-saved-none wv-quiet" }, "No views are saved yet.");
  const name = textField("Name of the view to save");
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
    tip: "New browsers and pictures begin with this view",
    icon: "flag",
  });
  const element = el(
    "section",
    { class: "wv-view", "aria-label": "Saved views" },
    el("div", { class: "wv-view-head" }, el("h2", { class: "wv-view-title" }, "Saved views")),
    list,
    empty,
    needs("SaveView", save),
    needs("StartWithView", start),
  );

  return {
    element,
    /** @param {SavedView[]} saved */
    update(saved) {
      const names = saved.map((view) => view.name);
      for (const gone of [...lines.keys()].filter((each) => !names.includes(each)))
        lines.delete(gone);
      for (const view of saved) {
        const known = lines.get(view.name) ?? line(view.name);
        lines.set(view.name, known);
        known.update(view);
      }
      setChildren(
        list,
        names.flatMap((each) => lines.get(each)?.element ?? []),
      );
      empty.hidden = saved.length > 0;
      const numbers = Array.from(
        { length: names.length + 1 },
        (_, index) => `${NAME} ${index + 1}`,
      );
      set(name, { placeholder: numbers.find((each) => !names.includes(each)) });
    },
  };
}

/** @param {string} name */
function line(name) {
  const type = el("span", { class: "wv-quiet" });
  const mark = el(
    "span",
    { class: "wv-saved-start", title: "Browsers begin with it" },
    icon("flag", 12),
  );
  const show = el(
    "button",
    {
      type: "button",
      class: "wv-saved-show",
      "aria-label": name,
      title: `Show ${name}`,
      onclick: () => act("ShowView", { view: name }),
      onkeydown: ({ key }) => key === "F2" && !why("RenameView") && rename(),
    },
    el("span", { class: "wv-saved-name" }, name),
    type,
    mark,
  );
  const field = textField(`New name of ${name}`, {
    hidden: true,
    onblur: () => take(),
    onkeydown(event) {
      if (event.key !== "Enter" && event.key !== "Escape") return;
      event.stopPropagation();
      event.preventDefault(); // else it presses the button that gets the focus
      if (event.key === "Escape") field.value = name;
      show.hidden = false;
      show.focus(); // which takes what was typed
    },
  });
  const element = el(
    "li",
    { class: "wv-saved-line" },
    show,
    field,
    needs(
      "StartWithView",
      tool("flag", `Start with ${name}`, () => act("StartWithView", { view: name })),
    ),
    needs("RenameView", tool("pencil", `Rename ${name}`, rename)),
    needs(
      "RemoveView",
      tool("trash", `Remove ${name}`, () => act("RemoveView", { name })),
    ),
  );

  function rename() {
    show.hidden = true;
    field.hidden = false;
    field.value = name;
    field.focus();
    field.select();
  }

  function take() {
    if (field.hidden) return;
    const newName = field.value.trim();
    field.hidden = true;
    show.hidden = false;
    if (newName && newName !== name) act("RenameView", { name, new_name: newName });
  }

  return {
    element,
    /** @param {SavedView} view */
    update(view) {
      setText(type, view.type);
      mark.hidden = !view.is_start;
    },
  };
}

/**
 * @param {string} iconName
 * @param {string} tip
 * @param {() => unknown} run
 */
function tool(iconName, tip, run) {
  return iconButton(iconName, tip, run, { size: 14 });
}
