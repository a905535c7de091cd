// The gallery of panels: what can be added, what it shows, and where it opens.

import { openDialog } from "webviz/controls/dialog.js";
import { textField } from "webviz/controls/fields.js";
import { OptionList, search } from "webviz/controls/option_list.js";
import { el } from "webviz/dom.js";
import { effect, root, signal } from "webviz/signals.js";

/** @import {PanelType} from "webviz/contents.js" */

/** @type {Record<string, string>} */
const PLACES = { side: "In the side bar", below: "Below the scene" };

/**
 * Lets the user choose a type of panels; resolves with it, null for none.
 *
 * @param {PanelType[]} types
 * @returns {Promise<PanelType | null>}
 */
export const chooseType = (types) =>
  root(async (end) => {
    const chosen = await openDialog({
      title: "Add panel",
      className: "wv-add wv-gallery",
      isLight: true,
      content: (close) => content(types, close),
    });
    end();
    return chosen;
  });

/**
 * @param {PanelType[]} types
 * @param {(type: PanelType) => void} close
 */
function content(types, close) {
  const text = signal("");
  const matches = () => search(types, text.value, ({ title, about }) => [title, about]);
  const input = textField("Search", { class: "wv-field wv-search", placeholder: "Search" });
  const list = new OptionList(input, "Panels", ({ id }) => {
    const type = types.find((each) => each.type === id);
    if (type) close(type);
  });
  // After that of the list, which then begins with the best match.
  input.addEventListener("input", () => (text.value = input.value));
  effect(() => list.show(matches().map(row)));
  const nothing = () => matches().length > 0;
  return [
    input,
    list.element,
    el("p", { class: "wv-quiet wv-nothing", hidden: nothing }, "No match."),
  ];
}

/** @param {PanelType} type */
const row = ({ type, title, about, icon, opens }) => ({
  id: type,
  title,
  icon,
  line: about,
  note: PLACES[opens] ?? PLACES.side,
});
