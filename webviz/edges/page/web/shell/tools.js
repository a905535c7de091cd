// The tools: which one is active on this page, and the pointer meanwhile.

import * as channel from "../channel.js";
import { el, set, setChildren, setText } from "../dom.js";
import { icon } from "../icons.js";
import * as stroke from "../scene/stroke.js";
import { canvas } from "../viser_page.js";
import { command, provide } from "./commands.js";
import { keyText } from "./keys.js";

const HINTS = {
  point: "Click on the ground. Esc cancels.",
  pose: "Press on the ground and drag towards the heading. Esc cancels.",
};
const SHOWN_MS = { ok: 5000, warn: 10000, error: 10000 };

/** The buttons of the tools, and a line of what to do and of what came of it. */
export const buttons = el("div", { class: "wv-tools", role: "group", "aria-label": "Tools" });
export const hint = el("output", { class: "wv-hint wv-card", hidden: true });

const listeners = new Set();
const made = new Map();
let tools = [];
let active = null;
let timer = 0;

/** Calls `listener` whenever there are other tools. */
export const onTools = (listener) => listeners.add(listener);

export function install() {
  channel.on("Tools", (message) => {
    tools = message.tools;
    if (active) active = tools.find(({ id }) => id === active.id) ?? null;
    if (!active) leave();
    show();
    for (const listener of listeners) listener();
  });
  channel.on("Told", ({ level, text }) => tell(level, text));
  provide(() =>
    tools.map((tool) => ({
      name: tool.name,
      icon: iconOf(tool),
      key: tool.shortcut || undefined,
      group: "Tools",
      run: () => toggle(tool),
    })),
  );
  command({
    name: "Leave the tool",
    key: "Escape",
    group: "Tools",
    isHidden: true,
    isThere: () => active !== null,
    run: () => select(null),
  });
  for (const name of ["pointerdown", "pointermove", "pointerup", "pointercancel", "wheel"]) {
    window.addEventListener(name, onPointer, { capture: true, passive: false });
  }
}

const iconOf = ({ gesture }) => (gesture === "pose" ? "pose" : "point");
const toggle = (tool) => select(tool.id === active?.id ? null : tool);

function show() {
  setChildren(
    buttons,
    tools.map((tool) => {
      const button = made.get(tool.id) ?? el("button", { type: "button", class: "wv-tool" });
      made.set(tool.id, button);
      const text = JSON.stringify(tool);
      if (button.dataset.tool !== text) {
        set(button, {
          "aria-label": tool.name,
          "data-tip": tool.tooltip,
          "data-key": tool.shortcut || null,
        });
        button.dataset.tool = text;
        button.replaceChildren(
          icon(iconOf(tool)),
          el("span", { class: "wv-tool-name" }, tool.name),
          ...(tool.shortcut ? [el("kbd", {}, keyText(tool.shortcut))] : []),
        );
        button.onclick = () => toggle(tool);
      }
      set(button, { "aria-pressed": String(tool.id === active?.id) });
      return button;
    }),
  );
}

function leave() {
  stroke.cancel();
  active = null;
  canvas().style.cursor = "";
}

function select(tool) {
  leave();
  active = tool;
  if (tool) canvas().style.cursor = "crosshair";
  tell("hint", tool ? HINTS[tool.gesture] : "");
  show();
}

function tell(level, text) {
  clearTimeout(timer);
  set(hint, { "data-level": level });
  setText(hint, text);
  hint.hidden = text === "";
  if (SHOWN_MS[level]) timer = setTimeout(() => tell("hint", ""), SHOWN_MS[level]);
}

function onPointer(event) {
  if (active === null) return;
  if (stroke.isGoing()) {
    event.stopImmediatePropagation(); // the camera stays where it is meanwhile
    if (event.type === "wheel") event.preventDefault();
    if (!stroke.follows(event)) return;
    if (event.type === "pointermove") stroke.move(event);
    if (event.type === "pointerup") stroke.end(event);
    if (event.type === "pointercancel") stroke.cancel();
  } else if (event.type === "pointerdown" && event.target === canvas() && event.button === 0) {
    event.stopImmediatePropagation();
    event.preventDefault();
    const tool = active;
    const done = (made) => {
      select(null);
      channel.send({ type: "StrokeDone", tool: tool.id, ...made });
    };
    if (!stroke.begin(event, tool, done))
      tell("warn", "There is no ground. Press below the horizon.");
  }
}
