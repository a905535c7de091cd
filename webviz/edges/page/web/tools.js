// The toolbar over the scene, its keys, and the pointer while a tool is active.

import * as channel from "./channel.js";
import * as stroke from "./scene/stroke.js";
import { canvas } from "./viser_page.js";

const HINTS = {
  point: "Click on the ground. Esc cancels.",
  pose: "Press on the ground and drag towards the heading. Esc cancels.",
};
const STYLE = `
  .webviz-tools { position: fixed; z-index: 6; display: flex; flex-wrap: wrap; gap: 6px;
    max-width: calc(100vw - 16px); font: 13px/1.3 system-ui, sans-serif; pointer-events: none }
  .webviz-tools button { pointer-events: auto; font: inherit; color: #eee; cursor: pointer;
    background: rgba(37, 38, 43, 0.92); border: 1px solid #5c5f66; border-radius: 4px;
    padding: 6px 10px; min-height: 34px }
  .webviz-tools button:hover { background: #373a40 }
  .webviz-tools button:focus-visible { outline: 2px solid #74c0fc }
  .webviz-tools button[aria-pressed="true"] { background: #1971c2; border-color: #74c0fc;
    color: #fff }
  .webviz-tools output { flex-basis: 100%; align-self: start; color: #fff; max-width: 34em }
  .webviz-tools output:not(:empty) { width: fit-content; flex-basis: auto; padding: 6px 10px;
    border-radius: 4px; background: rgba(37, 38, 43, 0.92) }
  .webviz-tools output[data-level="warn"] { background: #7a4a00 }
  .webviz-tools output[data-level="error"] { background: #a61e1e }
`;
const SHOWN_MS = { ok: 5000, warn: 10000, error: 10000 };

let tools = [];
let active = null;
let bar = null;
let told = null;
let timer = 0;

export function install() {
  channel.on("Tools", (message) => {
    tools = message.tools;
    if (active) active = tools.find(({ id }) => id === active.id) ?? null;
    if (!active) stroke.cancel();
    build();
  });
  channel.on("Told", ({ level, text }) => tell(level, text));
  const style = document.createElement("style");
  style.textContent = STYLE;
  bar = document.createElement("div");
  bar.className = "webviz-tools";
  bar.setAttribute("role", "toolbar");
  bar.setAttribute("aria-label", "Tools");
  told = document.createElement("output");
  document.head.append(style);
  document.body.append(bar);
  build();
  new ResizeObserver(place).observe(canvas());
  window.addEventListener("resize", place);
  window.addEventListener("keydown", onKey);
  for (const name of ["pointerdown", "pointermove", "pointerup", "pointercancel", "wheel"]) {
    window.addEventListener(name, onPointer, { capture: true, passive: false });
  }
}

function build() {
  bar.replaceChildren(
    ...tools.map((tool) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = tool.name;
      button.title = tool.tooltip + (tool.shortcut ? ` (${tool.shortcut.toUpperCase()})` : "");
      button.setAttribute("aria-pressed", tool === active);
      button.addEventListener("click", () => select(tool === active ? null : tool));
      return button;
    }),
    told,
  );
  place();
}

// Over the scene, which shares the window with the panel.
function place() {
  const { left, top } = canvas().getBoundingClientRect();
  bar.style.left = `${left + 8}px`;
  bar.style.top = `${top + 8}px`;
}

function select(tool) {
  stroke.cancel();
  active = tool;
  canvas().style.cursor = tool ? "crosshair" : "";
  tell("hint", tool ? HINTS[tool.gesture] : "");
  build();
}

function tell(level, text) {
  clearTimeout(timer);
  told.dataset.level = level;
  told.textContent = text;
  if (SHOWN_MS[level]) timer = setTimeout(() => tell("hint", ""), SHOWN_MS[level]);
}

function onKey(event) {
  const isTyping = event.target.closest?.("input, textarea, select, [contenteditable]");
  if (event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
  if (event.key === "Escape" && active) return select(null);
  if (isTyping || event.target.closest?.("[role=dialog]")) return;
  // As in RViz, the last tool with a key has it.
  const tool = tools.findLast(({ shortcut }) => shortcut && shortcut === event.key.toLowerCase());
  if (tool) select(tool === active ? null : tool);
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
    if (!stroke.begin(event, tool, done)) tell("warn", "There is no ground. Press below the horizon.");
  }
}
