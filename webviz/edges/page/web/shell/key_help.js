// All keys in a dialog (?), made of the commands that have some.

import { el } from "../dom.js";
import { all, keysOf } from "./commands.js";
import { openDialog } from "./dialog.js";
import { keyText } from "./keys.js";

const ORDER = ["File", "Edit", "View", "Time", "Tools", "Displays"];

// What the scene itself listens to, see scene/mouse.js; and viser's camera.
const SCENE = [
  ["Turn the view", ["Drag"]],
  ["Move the view", ["Shift+Drag", "Middle button"]],
  ["Zoom", ["Wheel", "Right button"]],
  ["Walk", ["W", "A", "S", "D"]],
  ["Down, up", ["Q", "E"]],
  ["Turn", ["←", "↑", "→", "↓"]],
  ["Look at what is under the mouse", ["F"]],
];

export function openKeys() {
  if (document.querySelector(".wv-keys[open]")) return;
  const groups = new Map(ORDER.map((name) => [name, []]));
  for (const one of all()) {
    if (!keysOf(one).length) continue;
    const group = one.group ?? "Tools";
    groups.set(group, [
      ...(groups.get(group) ?? []),
      [one.name.replace("…", ""), keysOf(one).map(keyText)],
    ]);
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
