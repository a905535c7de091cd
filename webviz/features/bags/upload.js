// Bags and reports of this computer: they are sent in parts, and played in the place of live topics.

import { act } from "webviz/act.js";
import { el } from "webviz/dom.js";
import { textButton } from "webviz/icons.js";
import { overlay } from "webviz/overlay/overlay.js";
import { fileLoader } from "webviz/shell/opening.js";
import { signal } from "webviz/signals.js";
import { toast } from "webviz/toasts.js";

/** @import {Signal} from "webviz/signals.js" */

/** @typedef {{name: string, share: number}} Progress */

const ENDINGS = [".mcap", ".db3", ".zip"];
const BLOCK = 512 << 10;
const PAUSE_MS = 130; // a part counts as 22 messages, of which an owner may send 200 a second

export function install() {
  /** @type {Signal<Progress | null>} */
  const progress = signal(/** @type {Progress | null} */ (null));
  overlay("cards", "upload", card(progress));
  fileLoader(ENDINGS, (file) => upload(file, progress));
}

/** @param {Signal<Progress | null>} progress */
const card = (progress) =>
  el(
    "section",
    { class: "wv-card wv-upload-card", role: "status", hidden: () => !progress.value },
    el("span", {}, () => progress.value?.name ?? ""),
    el("span", { class: "wv-number" }, () => `${Math.floor(100 * (progress.value?.share ?? 0))} %`),
    textButton("Cancel", () => {
      progress.value = null;
    }),
  );

/**
 * @param {File} file
 * @param {Signal<Progress | null>} progress
 */
async function upload(file, progress) {
  if (progress.value) {
    toast("Another file is being uploaded. Wait for it, or cancel it.", { level: "warn" });
    return;
  }
  progress.value = { name: file.name, share: 0 };
  try {
    const path = await send(file, progress);
    if (path) await act("OpenRecording", { path });
  } finally {
    progress.value = null;
  }
}

/**
 * Sends a file; its path there, "" if that failed or was cancelled.
 *
 * @param {File} file
 * @param {Signal<Progress | null>} progress
 */
async function send(file, progress) {
  const fields = { name: file.name, size: file.size };
  const { level, token } = await act("BeginUpload", fields, { quiet: true });
  if (level === "error") return "";
  for (let offset = 0; progress.value; offset += BLOCK) {
    const text = await base64(file.slice(offset, offset + BLOCK));
    const pause = new Promise((resolve) => setTimeout(resolve, PAUSE_MS));
    const answer = await act("UploadPart", { token, offset, text }, { quiet: true });
    if (answer.level === "error" || answer.path) return answer.path ?? "";
    if (progress.value) progress.value = { name: file.name, share: offset / file.size };
    await pause;
  }
  return "";
}

/**
 * @param {Blob} blob
 * @returns {Promise<string>}
 */
const base64 = (blob) =>
  new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(String(reader.result).replace(/^[^,]*,/, ""));
    reader.onerror = () => reject(reader.error);
    reader.readAsDataURL(blob);
  });
