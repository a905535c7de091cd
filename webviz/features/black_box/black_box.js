// Recordings that the rules of the config made: a button with a menu, for the owner.

import { onRole, self } from "webviz/access.js";
import { act } from "webviz/act.js";
import { copy } from "webviz/clipboard.js";
import { el } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { openMenu } from "webviz/controls/menu.js";
import { timeBarButton } from "webviz/shell/time_bar.js";
import { toast } from "webviz/toasts.js";
import { signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { savedText } from "webviz/time_text.js";

/** @typedef {[name: string, megabytes: number, path: string, command: string]} Saved */

const HINT = "Recordings that rules have saved: choose one to play it here";

const values = store("black_box");

export const install = () => timeBarButton(blackBox());

/** The button; hidden while there are neither rules nor recordings. */
function blackBox() {
  const isOwner = signal(false);
  onRole(() => (isOwner.value = self().role === "owner"));
  const all = () => values.get("saved") ?? [];
  const saving = () => values.get("saving");
  /** @type {HTMLButtonElement} */
  const button = el(
    "button",
    {
      type: "button",
      class: "wv-button wv-black-box",
      hidden: () => !isOwner.value || !values.has("saved"),
      "aria-label": "Black box",
      "data-tip": () =>
        isOwner.value && saving() ? `Saves ${saving()}, until 10 s after it` : HINT,
      onclick: () => open(button, all()),
    },
    icon("flag", 14),
    el("span", {}, () => {
      if (!isOwner.value) return "";
      return saving() ? "Saving…" : String(all().length);
    }),
  );
  return button;
}

/**
 * A menu of recordings above a button.
 *
 * @param {HTMLElement} button
 * @param {Saved[]} saved
 */
function open(button, saved) {
  const { left, top } = button.getBoundingClientRect();
  if (!saved.length) {
    toast("No rule has saved a recording yet.");
    return;
  }
  /** @param {string} name @param {number} megabytes */
  const label = (name, megabytes) => `${savedText(name)} · ${megabytes} MB`;
  openMenu(left, top, [
    ...saved.map(([name, megabytes, path]) => ({
      label: label(name, megabytes),
      icon: "play",
      needs: "OpenRecording",
      run: () => act("OpenRecording", { path }),
    })),
    null,
    {
      label: "Copy the command that opens",
      icon: "copy",
      items: saved.map(([name, megabytes, , command]) => ({
        label: label(name, megabytes),
        run: () => copyCommand(command),
      })),
    },
  ]);
}

/** @param {string} command */
async function copyCommand(command) {
  const isCopied = await copy(command);
  toast(isCopied ? `Copied: ${command}` : command);
}
