// Renaming where the name is read.

import { why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { el } from "webviz/dom.js";

/** @import {Item, Row} from "webviz/panels/displays/types.js" */

/**
 * Turns the name of a row into a text field; Enter or leaving keeps it, Escape does not.
 *
 * @param {Row} row
 * @param {Item} item
 */
export function rename(row, item) {
  if (why("SetProperty") || row.element.querySelector(".wv-tree-rename")) return;
  const field = el("input", {
    class: "wv-field wv-tree-rename",
    "aria-label": "Name",
    maxlength: 10000,
    spellcheck: "false",
  });
  field.value = item.name;
  row.name.hidden = true;
  row.name.after(field);
  field.focus();
  field.select();
  let isDone = false;

  /** @param {boolean} isKept */
  function finish(isKept) {
    if (isDone) return;
    isDone = true;
    const hadFocus = field === document.activeElement;
    field.remove();
    row.name.hidden = false;
    if (hadFocus) row.row.focus({ preventScroll: true });
    const name = field.value.trim();
    if (isKept && name !== item.name)
      act("SetProperty", { display: item.id, path: "name", value: name });
  }

  field.addEventListener("blur", () => finish(true));
  field.addEventListener("keydown", (event) => {
    event.stopPropagation();
    if (event.isComposing) return;
    if (event.key === "Enter") finish(true);
    if (event.key === "Escape") finish(false);
  });
}
