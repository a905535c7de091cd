// Texts about handles. Without a document.

/** @import {HandleControl, SceneHandle} from "webviz/contents.js" */

/** @type {Partial<Record<HandleControl["mode"], string>>} */
const DOES = { menu: "Show menu", button: "Activate" };
const TURNS = /^rotate/;

/**
 * A sentence about the browser that drags a handle, "" if none does.
 *
 * @param {Pick<SceneHandle, "holder">} handle
 */
export const heldText = ({ holder }) => (holder === null ? "" : `In use by browser ${holder}.`);

/**
 * The hint about a control under the pointer: its help, and the buttons of the mouse.
 *
 * @param {Pick<SceneHandle, "name" | "holder" | "menu">} handle
 * @param {Pick<HandleControl, "mode" | "help">} control
 * @param {string} refusal the reason for which this page drags no handles, "" for none
 */
export function helpOf(handle, { mode, help }, refusal) {
  if (refusal) return `${handle.name}: ${refusal}`;
  const does = DOES[mode] ?? (TURNS.test(mode) ? "Rotate" : "Move");
  const more = mode !== "menu" && handle.menu.length ? "Right-click: Show context menu." : "";
  const texts = [help || handle.name, `Left-click: ${does}.`, more, heldText(handle)];
  return texts.filter(Boolean).join(" ");
}
