import assert from "node:assert/strict";
import { afterEach, test } from "node:test";

import { keyOf, keyText, shortcutGroups, shortcuts } from "../../webviz/page/web/keys.js";
import * as keys from "../../webviz/features/driving/teleop_keys.js";

/**
 * An event of a key, which Node.js does not have.
 *
 * @param {Partial<KeyboardEvent>} said
 */
const event = (said) =>
  /** @type {KeyboardEvent} */ ({
    altKey: false,
    ctrlKey: false,
    metaKey: false,
    shiftKey: false,
    repeat: false,
    ...said,
  });

/**
 * @param {string} code
 * @param {Partial<KeyboardEvent>} [more]
 */
const press = (code, more = {}, canGoSideways = true) =>
  keys.press(event({ code, ...more }), canGoSideways);

afterEach(() => keys.release());

test("keys are written as they are read", () => {
  assert.equal(keyText("Ctrl+Shift+s"), "Ctrl+Shift+S");
  assert.equal(keyText("ArrowUp"), "↑");
  assert.equal(keyText("Alt+ArrowDown"), "Alt+↓");
  assert.equal(keyText(" "), "Space");
  assert.equal(keyText("Escape"), "Esc");
  assert.equal(keyText("+"), "+");
  assert.equal(keyText("F2"), "F2");
});

test("on a Mac Ctrl is the command key", async () => {
  const here = Object.getOwnPropertyDescriptor(globalThis, "navigator");
  Object.defineProperty(globalThis, "navigator", {
    value: { platform: "MacIntel" },
    configurable: true,
  });
  const mac = await import(`${import.meta.resolve("../../webviz/page/web/keys.js")}?mac`);
  if (here) Object.defineProperty(globalThis, "navigator", here);
  assert.equal(mac.keyText("Ctrl+z"), "⌘+Z");
  assert.equal(keyText("Ctrl+z"), "Ctrl+Z");
});

test("an event is named as commands name their keys", () => {
  assert.equal(keyOf(event({ key: "S", ctrlKey: true, shiftKey: true })), "Ctrl+Shift+s");
  assert.equal(keyOf(event({ key: "s", metaKey: true })), "Ctrl+s");
  assert.equal(keyOf(event({ key: "?", shiftKey: true })), "?");
  assert.equal(keyOf(event({ key: "Delete", shiftKey: true })), "Shift+Delete");
  assert.equal(keyOf(event({ key: "ArrowUp", altKey: true })), "Alt+ArrowUp");
  assert.equal(keyOf(event({ key: "É" })), "é");
});

test("keys drive while they are held", () => {
  assert.ok(press("KeyW") && press("KeyA"));
  assert.deepEqual(keys.share(), [1, 0, 1]);
  press("ArrowUp");
  assert.deepEqual(keys.share(), [1, 0, 1], "two keys for the same direction add no speed");
  press("KeyS");
  keys.lift(event({ code: "ArrowUp" }));
  assert.deepEqual(keys.share(), [0, 0, 1], "opposite keys cancel");
  keys.release();
  assert.deepEqual(keys.share(), [0, 0, 0]);
});

test("other keys than those for driving are not handled", () => {
  assert.equal(press("KeyX"), false);
  assert.deepEqual(keys.share(), [0, 0, 0]);
});

test("a robot that cannot go sideways ignores Q and E, which the camera must not get", () => {
  assert.equal(press("KeyQ", {}, false), true);
  assert.deepEqual(keys.share(), [0, 0, 0]);
  press("KeyE");
  assert.deepEqual(keys.share(), [0, -1, 0]);
});

test("a repeat begins nothing, and a shortcut ends all that is held", () => {
  assert.equal(press("KeyW", { repeat: true }), true);
  assert.deepEqual(keys.share(), [0, 0, 0]);
  press("KeyW");
  assert.equal(press("KeyD", { ctrlKey: true }), false);
  assert.deepEqual(keys.share(), [0, 0, 0]);
});

test("shortcuts of a part follow the table of keys", () => {
  /** @type {unknown[]} */
  const done = [];
  const take = shortcuts("A part", [
    { does: "Zoom", keys: ["Wheel"] },
    { does: "Zoom", keys: ["+"], unnamed: ["="], run: (context) => done.push(context) },
    { does: "Never", keys: ["0"], run: () => false },
    { does: "Go", keys: [], unnamed: ["Home"], run: () => done.push("home") },
  ]);
  assert.equal(shortcutGroups().get("A part")?.length, 4);
  assert.equal(take("here", event({ key: "=" })), true);
  assert.equal(take("here", event({ key: "Home" })), true);
  assert.equal(take("here", event({ key: "0" })), false, "it does nothing now");
  assert.equal(take("here", event({ key: "+", ctrlKey: true })), false);
  assert.deepEqual(done, ["here", "home"]);
});
