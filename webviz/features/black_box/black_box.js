// Recordings that the rules of the config made: a button with a menu, for the owner.

import { onRole, self } from "webviz/access.js";
import { act } from "webviz/act.js";
import { copy } from "webviz/clipboard.js";
import { el, set, setText } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { openMenu } from "webviz/controls/menu.js";
import { timeBarButton } from "webviz/shell/time_bar.js";
import { toast } from "webviz/toasts.js";
import { watch } from "webviz/stores.js";
import { savedText } from "webviz/time_text.js";

export const install = () => timeBarButton(blackBox());

/** The button; hidden while there are neither rules nor recordings. */
function blackBox() {
  /** @type {[name: string, megabytes: number, path: string, command: string][]} */
  let saved = [];
  const label = el("span");
  const button = el(
    "button",
    {
      type: "button",
      class: "wv-button wv-black-box",
      hidden: true,
      "aria-label": "Black box",
      onclick: open,
    },
    icon("flag", 14),
    label,
  );

  /** @param {string} command */
  async function copyCommand(command) {
    const isCopied = await copy(command);
    toast(isCopied ? `Copied: ${command}` : command);
  }

  function open() {
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

  onRole(() => {
    if (self().role !== "owner") return;
    watch("black_box", (values) => {
      saved = values.get("saved") ?? [];
      button.hidden = !values.has("saved");
      setText(label, values.get("saving") ? "Saving…" : String(saved.length));
      set(button, {
        "data-tip": values.get("saving")
          ? `Saves ${values.get("saving")}, until 10 s after it`
          : "Recordings that rules have saved: choose one to play it here",
      });
    });
  });
  return button;
}
