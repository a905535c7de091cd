// All keys in a dialog (?), from the one table of them, also those of another moment.

import { el } from "webviz/dom.js";
import { keyTable } from "webviz/commands.js";
import { openDialog } from "webviz/controls/dialog.js";
import { keyText } from "webviz/keys.js";

const FIRST = ["File", "Edit", "View", "Time", "Tools", "Displays"];
const LAST = "Scene";

export function openKeys() {
  if (document.querySelector(".wv-keys[open]")) return;
  const table = keyTable();
  const others = [...table.keys()].filter((name) => !FIRST.includes(name) && name !== LAST);
  openDialog({
    title: "Keyboard and mouse",
    className: "wv-keys",
    isLight: true,
    content: el(
      "div",
      { class: "wv-key-groups" },
      [...FIRST, ...others, LAST].map((name) => group(name, table.get(name))),
    ),
  });
}

/**
 * @param {string} name
 * @param {Map<string, string[]>} [rows] keys by what they do
 */
function group(name, rows) {
  if (!rows) return null;
  return el(
    "section",
    {},
    el("h3", {}, name),
    el(
      "dl",
      {},
      [...rows].map(([does, keys]) =>
        el(
          "div",
          {},
          el("dt", {}, does.replace("…", "")),
          el(
            "dd",
            {},
            keys.map((key) => el("kbd", {}, keyText(key))),
          ),
        ),
      ),
    ),
  );
}
