// The panel "Displays": the search field, the tree, and the properties of what is selected.

import { needs } from "webviz/access.js";
import { searchField } from "webviz/controls/fields.js";
import { el } from "webviz/dom.js";
import { icon, iconButton } from "webviz/icons.js";
import { openAdd } from "webviz/panels/displays/add.js";
import { command } from "webviz/commands.js";
import { keyText } from "webviz/keys.js";
import { openMenuBelow } from "webviz/controls/menu.js";
import * as actions from "webviz/panels/displays/actions.js";
import { buildDetails } from "webviz/panels/displays/details.js";
import * as folding from "webviz/panels/displays/folding.js";
import { topmost } from "webviz/panels/displays/model.js";
import * as selection from "webviz/panels/displays/selection.js";
import { signal } from "webviz/signals.js";
import { DisplayTree } from "webviz/panels/displays/tree.js";

/** @import {Command} from "webviz/commands.js" */
/** @import {Signal} from "webviz/signals.js" */
/** @import {Panel} from "webviz/types.js" */
/** @import {Tree} from "webviz/panels/displays/types.js" */

const starts = signal(/** @type {readonly (() => HTMLElement)[]} */ ([]));

/**
 * Adds what stands above the tree.
 *
 * @param {() => HTMLElement} make called when the panel is opened
 */
export const displaysStart = (make) => (starts.value = [...starts.value, make]);

/** @type {Panel} */
export const displays = {
  name: "displays",
  title: "Displays",
  order: 0,
  open(panel) {
    const field = searchField("Filter displays", () => tree.setSearch(field.value), {
      spellcheck: "false",
      autocomplete: "off",
      onkeydown: (/** @type {KeyboardEvent} */ event) => searchBy(event, field, tree),
    });
    const hint = el("kbd", { class: "wv-tree-hint", "aria-hidden": "true" }, keyText("Ctrl+f"));
    /** @type {HTMLButtonElement} */
    const more = iconButton(
      "dots",
      "List options",
      () => openMenuBelow(more, optionsOf(tree, details.isOpen)),
      {
        "aria-haspopup": "menu",
      },
    );
    const details = buildDetails();
    const tree = new DisplayTree({
      after: addButton(),
      changed({ items, search }) {
        // Properties stand once: not below the tree while they are in it.
        const isInTree = items.length === 1 && !items[0].isGroup && folding.isOpen(items[0]);
        details.items.value = isInTree ? [] : items;
        if (field.value !== search) field.value = search;
      },
    });
    panel.append(
      el(
        "div",
        { class: "wv-tree-filter" },
        el("div", { class: "wv-tree-search" }, field, hint),
        more,
      ),
      el("div", { class: "wv-displays-start" }, () => starts.value.map((make) => make())),
      tree.element,
      details.element,
    );

    const isHere = () => {
      const side = panel.closest(".wv-side") ?? panel;
      return side.matches(":hover") || side.contains(document.activeElement);
    };
    const ends = [
      ...commandsOf(tree, isHere),
      command({
        name: "Filter displays",
        icon: "search",
        key: "Ctrl+f",
        group: "Displays",
        inFields: true,
        isKeyHere: isHere,
        run: () => field.select(),
      }),
    ];
    return () => {
      for (const end of ends) end();
      tree.close();
    };
  },
};

/**
 * @param {KeyboardEvent} event
 * @param {HTMLInputElement} field
 * @param {Tree} tree
 */
function searchBy(event, field, tree) {
  if (event.key === "Escape" && field.value) tree.setSearch((field.value = ""));
  else if (event.key === "ArrowDown") tree.showActive();
  else return;
  event.preventDefault();
  event.stopPropagation();
}

const addButton = () =>
  needs(
    "AddDisplay",
    el(
      "button",
      { type: "button", class: "wv-tree-add", onclick: () => openAdd() },
      icon("plus", 14),
      "Add display",
      el("kbd", { "aria-hidden": "true" }, keyText("Insert")),
    ),
  );

/**
 * The menu of the list.
 *
 * @param {Tree} tree
 * @param {Signal<boolean>} hasDetails whether properties are shown below the tree
 */
function optionsOf(tree, hasDetails) {
  /** @param {boolean} isOpen */
  const choose = (isOpen) => () => (hasDetails.value = isOpen);
  /** @param {boolean} isOpen */
  const fold = (isOpen) => () => {
    for (const item of tree.model().items) if (item.isGroup) folding.setOpen(item, isOpen);
    tree.refresh();
  };
  const isSeveral = selection.severalAtOnce();
  return [
    { label: "Properties below the tree", checked: hasDetails.value, run: choose(true) },
    { label: "Properties in the tree only", checked: !hasDetails.value, run: choose(false) },
    null,
    {
      label: "Select several",
      checked: isSeveral,
      run: () => selection.selectSeveral(!selection.severalAtOnce()),
    },
    null,
    { label: "Unfold all groups", run: fold(true) },
    { label: "Fold all groups", run: fold(false) },
  ];
}

/**
 * Adds the commands about what is selected in the tree; returns what ends each.
 *
 * @param {Tree} tree
 * @param {() => boolean} isHere whether keys are for the panel
 */
function commandsOf(tree, isHere) {
  const chosen = () => topmost(tree.model(), selection.ids());
  const isOne = () => chosen().length === 1;
  /**
   * @param {string} name
   * @param {Partial<Command> & {run: () => unknown}} definition
   */
  const about = (name, definition) =>
    command({ name, group: "Displays", isThere: () => chosen().length > 0, ...definition });
  return [
    about("Focus on display", {
      icon: "focus",
      isThere: isOne,
      run: () => actions.focus(chosen()[0]),
    }),
    about("Duplicate display", {
      icon: "copy",
      key: "Ctrl+d",
      needs: "DuplicateDisplay",
      run: () => actions.duplicate(chosen()),
    }),
    about("Rename display", {
      key: "F2",
      needs: "SetProperty",
      isThere: isOne,
      isKeyHere: isHere,
      run: () => tree.rename(chosen()[0].id),
    }),
    about("Remove display", {
      icon: "trash",
      key: "Delete",
      needs: "RemoveDisplay",
      isKeyHere: isHere,
      run: () => actions.remove(tree.model(), tree.rows(), chosen()),
    }),
  ];
}
