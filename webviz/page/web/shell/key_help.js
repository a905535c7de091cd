// All keys in a dialog (?), made of the commands that have some, also of those of another moment.

import { el } from "../dom.js";
import { keysOf, known } from "../commands.js";
import { openDialog } from "../controls/dialog.js";
import { keyText } from "../keys.js";

/** @typedef {[does: string, keys: string[]]} KeyRow */

const ORDER = ["File", "Edit", "View", "Time", "Tools", "Displays"];

// Keys of the scene itself, see scene/mouse.js; and viser's camera.
/** @type {KeyRow[]} */
const SCENE = [
  ["Turn the view", ["Drag"]],
  ["Move the view", ["Shift+Drag", "Middle button"]],
  ["Zoom", ["Wheel", "Right button"]],
  ["Walk", ["W", "A", "S", "D"]],
  ["Down, up", ["Q", "E"]],
  ["Turn", ["←", "↑", "→", "↓"]],
  ["Look at what is under the mouse", ["F"]],
];

// Keys of the tree of displays while it has the focus, see panels/displays/keys.js.
/** @type {KeyRow[]} */
const TREE = [
  ["Show or hide displays", ["Space"]],
  ["Copy as YAML", ["Ctrl+c"]],
  ["Select all", ["Ctrl+a"]],
  ["Unfold, fold", ["→", "←"]],
  ["Properties in the tree", ["Enter"]],
  ["Move in the list", ["Alt+↑", "Alt+↓"]],
  ["Into and out of a group", ["Alt+→", "Alt+←"]],
  ["Actions", ["Shift+F10"]],
];

// Keys of an image while it has the focus, see images/zoom.js.
/** @type {KeyRow[]} */
const IMAGE = [
  ["Zoom", ["Wheel", "+", "-"]],
  ["Move", ["Drag", "←", "↑", "→", "↓"]],
  ["Show all of it", ["0"]],
];

/** @type {KeyRow[]} */
const TELEOP = [
  ["Drive", ["W", "A", "S", "D"]],
  ["Drive with one hand", ["↑", "←", "↓", "→"]],
];

export function openKeys() {
  if (document.querySelector(".wv-keys[open]")) return;
  /** @type {Map<string, KeyRow[]>} */
  const groups = new Map(ORDER.map((name) => [name, []]));
  for (const one of known()) {
    if (!keysOf(one).length) continue;
    const group = one.group ?? "Tools";
    groups.set(group, [
      ...(groups.get(group) ?? []),
      [one.name.replace("…", ""), keysOf(one).map(keyText)],
    ]);
  }
  const further = { "Tree of displays": TREE, Image: IMAGE, "While driving": TELEOP };
  for (const [name, keys] of Object.entries(further)) {
    groups.set(
      name,
      keys.map(([does, all]) => [does, [...all].map(keyText)]),
    );
  }
  groups.set("Scene", SCENE);
  openDialog({
    title: "Keyboard and mouse",
    className: "wv-keys",
    isLight: true,
    content: el(
      "div",
      { class: "wv-key-groups" },
      [...groups].filter(([, rows]) => rows.length).map(([name, rows]) => group(name, rows)),
    ),
  });
}

/**
 * @param {string} name
 * @param {KeyRow[]} rows
 */
function group(name, rows) {
  return el(
    "section",
    {},
    el("h3", {}, name),
    el(
      "dl",
      {},
      rows.map(([does, keys]) =>
        el(
          "div",
          {},
          el("dt", {}, does),
          el(
            "dd",
            {},
            keys.map((key) => el("kbd", {}, key)),
          ),
        ),
      ),
    ),
  );
}
