// Files that the viewer wrote for this page: where each is, and how one gets it.

import { onRole, why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { copyAndTell } from "webviz/clipboard.js";
import { provide } from "webviz/commands.js";
import { save } from "webviz/download.js";
import { el } from "webviz/dom.js";
import { iconButton, textButton } from "webviz/icons.js";
import { overlay } from "webviz/overlay/overlay.js";
import { signal, untracked } from "webviz/signals.js";
import { store, watch } from "webviz/stores.js";
import { toast } from "webviz/toasts.js";

/** @import {WrittenFile} from "webviz/contents.js" */
/** @import {Signal} from "webviz/signals.js" */

/** @typedef {WrittenFile & {number: number}} Written */

const MAX_BYTES = 4e9; // that a browser keeps until the file is complete

export function install() {
  onRole(() => {
    if (why("ReadOutput")) return;
    /** @type {Signal<Written | null>} */
    const latest = signal(null);
    overlay("cards", "output", card(latest));
    /** @type {Set<string>} */
    let before = new Set();
    watch("outputs", (values) => {
      const files = [...values].map(([number, file]) => ({ ...file, number: Number(number) }));
      const mine = files.filter(({ browser }) => browser === window.webviz.browser);
      const added = mine.filter((file) => !before.has(key(file))).at(-1);
      before = new Set(files.map(key));
      const shown = untracked(() => latest.value);
      // Another file may have its number in a viewer that was started again.
      if (added || (shown && !before.has(key(shown)))) latest.value = added ?? null;
    });
    provide(() => commands(latest));
  });
}

/** @param {Written} file */
const key = ({ number, path }) => `${number} ${path}`;

/** @param {Signal<Written | null>} latest */
const commands = (latest) =>
  [...store("outputs").all()].map(([number, file]) => ({
    name: `Show ${file.name}`,
    group: "Files",
    run: () => {
      latest.value = { ...file, number: Number(number) };
    },
  }));

/**
 * Return a card of a file: its place and what one does with it; hidden without one.
 *
 * @param {Signal<Written | null>} latest
 */
function card(latest) {
  const progress = signal("");
  const file = () => latest.value;
  const close = () => {
    latest.value = null;
  };
  const current = () => /** @type {Written} */ (latest.value);
  const openHere = {
    type: "button",
    class: "wv-button",
    hidden: () => file()?.kind === "shared",
    onclick: () => act("OpenRecording", { path: current().path }).then(closeIfDone),
  };
  /** @param {{level: string}} answer */
  function closeIfDone({ level }) {
    if (level !== "error") close();
  }
  return el(
    "section",
    { class: "wv-card wv-output", "aria-label": "File", role: "status", hidden: () => !file() },
    el(
      "div",
      { class: "wv-output-head" },
      el("b", {}, () => file()?.text ?? ""),
      iconButton("close", "Dismiss", close, { tip: null }),
    ),
    el("code", {}, () => file()?.path ?? ""),
    el(
      "div",
      { class: "wv-output-buttons" },
      el(
        "button",
        {
          type: "button",
          class: "wv-button wv-primary",
          disabled: () => progress.value !== "",
          onclick: () => fetchFiles(current(), progress),
        },
        () => progress.value || "Download",
      ),
      textButton("Copy path", () => copyAndTell(current().path, "Path copied.")),
      el("button", openHere, "Open here"),
    ),
  );
}

/**
 * Downloads a file, or all files of a folder, one after the other.
 *
 * @param {Written} written
 * @param {Signal<string>} progress
 */
async function fetchFiles({ number }, progress) {
  try {
    let count = 1;
    for (let file = 0; file < count; file++) {
      const got = await fetchFile(number, file, progress);
      if (!got) return;
      count = got.count;
      save(got.name, got.blob);
    }
  } finally {
    progress.value = "";
  }
}

/**
 * @param {number} number
 * @param {number} file
 * @param {Signal<string>} progress
 */
async function fetchFile(number, file, progress) {
  /** @type {Uint8Array<ArrayBuffer>[]} */
  const parts = [];
  let offset = 0;
  while (true) {
    progress.value ||= "Downloading…";
    const answer = await act("ReadOutput", { number, file, offset }, { quiet: true });
    if (answer.level === "error") return null;
    const size = Number(answer.size);
    if (size > MAX_BYTES) {
      toast("Not downloaded: the file is larger than 4 GB. Copy its path instead.", {
        level: "error",
      });
      return null;
    }
    const part = Uint8Array.from(atob(answer.data), (character) => character.charCodeAt(0));
    parts.push(part);
    offset += part.length;
    progress.value = `${Math.floor((100 * offset) / Math.max(size, 1))} %`;
    if (offset >= size || !part.length)
      return { name: answer.name, count: Number(answer.count), blob: new Blob(parts) };
  }
}
