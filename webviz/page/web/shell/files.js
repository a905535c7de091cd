// The config file: saving, opening, downloading.

import { act } from "../act.js";
import * as channel from "../channel.js";
import { textField } from "../controls/fields.js";
import { el, setText } from "../dom.js";
import { icon, textButton } from "../icons.js";
import { each, root } from "../signals.js";
import { store } from "../stores.js";
import { ask, openDialog } from "../controls/dialog.js";
import { download } from "../download.js";
import { checkedName, hasSuffix, SUFFIXES } from "./file_names.js";
import { toast } from "../toasts.js";

/** @import {Children} from "../types.js" */
/** @import {Close} from "../controls/dialog.js" */
/** @import {Commands} from "../messages.js" */

const MAX_BYTES = 2 << 20;
const MAX_CHARACTERS = (3 << 20) - 1000; // of a message with the config in it
const NEW_NAME = "webviz.yaml";

/** @type {((close: Close) => Children[])[]} */
const sections = [];
/** @type {Map<string, (file: File) => unknown>} */
const loaders = new Map();

const file = store("file");

/**
 * The last part of a path.
 *
 * @param {string} path
 */
const baseName = (path) => path.slice(path.lastIndexOf("/") + 1);
/** The name of the file, "" if there is none; read in effects, as all that follows. */
export const fileName = () => baseName(path());
export const path = () => file.get("path") ?? "";
export const isChanged = () => file.get("is_changed") ?? false;
/** True once the server has reported the file. */
export const isThere = () => typeof file.get("folder") === "string";
const others = () => file.get("others") ?? [];

export const install = () => channel.on("Download", ({ name, text }) => download(name, text));

export const save = () => (path() ? act("Save") : saveAs());

/**
 * Sends the config here, as "yaml" or "rviz".
 *
 * @param {"yaml" | "rviz"} suffix
 */
export const exportAs = (suffix) =>
  act("Export", { name: `${(fileName() || NEW_NAME).replace(/\.[^.]*$/, "")}.${suffix}` });

export function saveAs() {
  const input = textField("File name", { autofocus: true });
  input.value = fileName() || NEW_NAME;
  const problem = el("p", { class: "wv-problem", role: "alert" });
  let confirmed = "";

  /** @param {(name: string) => string | null} check */
  function accepted(check) {
    const { name = "", problem: text } = checkedName(input.value);
    setText(problem, text ?? check(name) ?? "");
    return problem.textContent === "";
  }

  /** @param {string} name */
  function replaces(name) {
    if (!others().includes(name) || name === fileName() || name === confirmed) return null;
    confirmed = name;
    return `${name} exists already. Save again to replace it.`;
  }

  const answer = openDialog({
    title: "Save as",
    content: [
      el("p", { class: "wv-quiet" }, `In ${file.get("folder")} of the machine that runs webviz:`),
      input,
      problem,
    ],
    buttons: [
      { label: "Download", value: "download", accept: () => accepted(() => null) },
      { label: "Cancel", value: null },
      { label: "Save", value: "save", primary: true, accept: () => accepted(replaces) },
    ],
  });
  const stem = input.value.lastIndexOf(".");
  input.setSelectionRange(0, stem > 0 ? stem : input.value.length);
  return answer.then((value) => {
    const { name } = checkedName(input.value);
    if (value === "save") act("Save", { path: name });
    if (value === "download") act("Export", { name });
  });
}

/**
 * Adds a section to the dialog "Open": `make(close)` returns its elements; `close({run})` closes it and
 * runs what was chosen.
 *
 * @param {(close: Close) => Children[]} make
 */
export const filesSection = (make) => sections.push(make);

/**
 * Has files with an ending opened by `load(file)`, which are dropped on the page or uploaded.
 *
 * @param {string[]} endings such as ".mcap"
 * @param {(file: File) => unknown} load
 */
export function fileLoader(endings, load) {
  for (const ending of endings) loaders.set(ending, load);
}

export const open = () =>
  root(async (end) => {
    const chosen = await openDialog({
      title: "Open",
      content: filesToOpen,
      buttons: [{ label: "Cancel", value: null }],
    });
    end();
    if (chosen?.run) return chosen.run();
    if (chosen?.upload) return load(chosen.upload);
    if (chosen?.name) return replace(chosen.name, "Open", { path: chosen.name });
  });

/** @param {Close} close */
function filesToOpen(close) {
  /** @param {string} name */
  const row = (name) =>
    el(
      "button",
      {
        type: "button",
        class: "wv-file-row",
        disabled: () => name === fileName() && !isChanged(),
        onclick: () => close({ name }),
      },
      icon("file"),
      el("span", {}, name),
    );
  /** @type {HTMLInputElement} */
  const upload = el("input", {
    type: "file",
    accept: [...SUFFIXES, ...loaders.keys()].join(","),
    hidden: true,
    "aria-label": "File of this computer",
    onchange: () => upload.files?.[0] && close({ upload: upload.files[0] }),
  });
  const rows = each(
    others,
    (name) => name,
    (_, name) => row(name),
  );
  return [
    el("p", { class: "wv-quiet" }, `In ${file.get("folder")} of the machine that runs webviz:`),
    el("div", { class: "wv-files", role: "group", "aria-label": "Files" }, rows, () =>
      others().length ? null : el("p", { class: "wv-quiet" }, "No config files there."),
    ),
    ...sections.map((make) => el("section", {}, ...make(close))),
    upload,
    textButton("Upload from this computer", () => upload.click(), {
      class: "wv-button wv-upload",
      icon: "upload",
    }),
  ];
}

/**
 * Opens a file of this computer.
 *
 * @param {File} upload
 */
export async function load(upload) {
  /** @param {string} text */
  const fail = (text) => toast(text, { level: "error" });
  const name = baseName(upload.name);
  const own = loaders.get(name.slice(name.lastIndexOf(".")).toLowerCase());
  if (own) return own(upload);
  if (!hasSuffix(name))
    return fail(`Not opened: ${name} is not a config. Choose a .yaml or .rviz file.`);
  const large = `Not opened: ${name} is too large for a config; the limit is 2 MB.`;
  if (upload.size > MAX_BYTES) return fail(large);
  let text;
  try {
    text = new TextDecoder("utf-8", { fatal: true }).decode(await upload.arrayBuffer());
  } catch {
    return fail(`Not opened: ${name} is not UTF-8 text.`);
  }
  if (JSON.stringify(text).length > MAX_CHARACTERS) return fail(large);
  return replace(name, "Load", { text, name });
}

/**
 * @template {keyof Commands} C
 * @param {string} name
 * @param {C} command
 * @param {Commands[C]} fields
 */
async function replace(name, command, fields) {
  const question = `Open ${name} and discard unsaved changes? Everyone on this page loses them.`;
  const options = { title: "Unsaved changes", confirm: "Discard", danger: true };
  if (!isChanged() || (await ask(question, options))) act(command, fields);
}
