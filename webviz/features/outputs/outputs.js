// Files that the viewer wrote for this page: where each is, and how one gets it.

import { onRole, why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { copyAndTell } from "webviz/clipboard.js";
import { provide } from "webviz/commands.js";
import { save } from "webviz/download.js";
import { el } from "webviz/dom.js";
import { iconButton, textButton } from "webviz/icons.js";
import { overlay } from "webviz/overlay/overlay.js";
import { signal } from "webviz/signals.js";
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
    const shown = signal(null);
    overlay("cards", "output", card(shown));
    const isNew = newest();
    watch("outputs", (values) => {
      const mine = [...values]
        .map(([number, file]) => ({ ...file, number: Number(number) }))
        .filter(isNew)
        .filter(({ browser }) => browser === window.webviz.browser);
      if (mine.length) shown.value = mine[mine.length - 1];
    });
    provide(() => commands(shown));
  });
}

/** Tells the files that were written since this page was opened. */
function newest() {
  const known = { number: -1 };
  return (/** @type {Written} */ { number }) => {
    const isNew = number > known.number;
    known.number = Math.max(number, known.number);
    return isNew;
  };
}

/** @param {Signal<Written | null>} shown */
const commands = (shown) =>
  [...store("outputs").all()].map(([number, file]) => ({
    name: `Show ${file.name}`,
    group: "Files",
    run: () => {
      shown.value = { ...file, number: Number(number) };
    },
  }));

/**
 * Return a card of a file: its place and what one does with it; hidden without one.
 *
 * @param {Signal<Written | null>} shown
 */
function card(shown) {
  const progress = signal("");
  const file = () => shown.value;
  const close = () => {
    shown.value = null;
  };
  const current = () => /** @type {Written} */ (shown.value);
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
