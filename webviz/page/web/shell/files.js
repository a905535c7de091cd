// The config file: saving, opening, downloading.

import { act } from "../act.js";
import * as channel from "../channel.js";
import { textField } from "../controls/fields.js";
import { el, setText } from "../dom.js";
import { icon, textButton } from "../icons.js";
import { listeners } from "../listeners.js";
import { watch } from "../stores.js";
import { ask, openDialog } from "../controls/dialog.js";
import { download } from "../download.js";
import { checkedName, hasSuffix, SUFFIXES } from "./file_names.js";
import { toast } from "../toasts.js";

/** @import {Commands} from "../messages.js" */

const MAX_BYTES = 2 << 20;
const MAX_CHARACTERS = (3 << 20) - 1000; // of a message with the config in it
const NEW_NAME = "webviz.yaml";

/** @type {{path: string, is_changed: boolean, folder: string | null, others: string[]}} */
let file = { path: "", is_changed: false, folder: null, others: [] };
const changes = listeners();

/**
 * The last part of a path.
 *
 * @param {string} path
 */
const baseName = (path) => path.slice(path.lastIndexOf("/") + 1);
/** The name of the file, "" if there is none. */
export const fileName = () => baseName(file.path);
export const path = () => file.path;
export const isChanged = () => file.is_changed;
/** True once the server has reported the file. */
export const isThere = () => file.folder !== null;

export function install() {
  watch("file", (values) => {
    file = {
      path: values.get("path"),
      is_changed: values.get("is_changed"),
      folder: values.get("folder"),
      others: values.get("others"),
    };
    changes.tell();
  });
  channel.on("Download", ({ name, text }) => download(name, text));
}

/**
 * Calls `listener` now and whenever the file is another one; returns what ends it.
 *
 * @param {() => void} listener
 */
export function onFile(listener) {
  listener();
  return changes.on(listener);
}

export const save = () => (file.path ? act("Save") : saveAs());

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
    if (!file.others.includes(name) || name === fileName() || name === confirmed) return null;
    confirmed = name;
    return `${name} exists already. Save again to replace it.`;
  }

  const answer = openDialog({
    title: "Save as",
    content: [
      el("p", { class: "wv-quiet" }, `In ${file.folder} of the machine that runs webviz:`),
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

export function open() {
  const list = el("div", { class: "wv-files", role: "group", "aria-label": "Files" });
  const upload = el("input", {
    type: "file",
    accept: SUFFIXES.join(","),
    hidden: true,
    "aria-label": "File of this computer",
  });
  /** @type {() => void} */
  let end = () => {};

  return openDialog({
    title: "Open",
    content(close) {
      /** @param {string} name */
      const row = (name) =>
        el(
          "button",
          {
            type: "button",
            class: "wv-file-row",
            disabled: name === fileName() && !file.is_changed,
            onclick: () => close({ name }),
          },
          icon("file"),
          el("span", {}, name),
        );
      end = onFile(() => {
        if (list.dataset.names === JSON.stringify(file.others)) return;
        list.dataset.names = JSON.stringify(file.others);
        list.replaceChildren(...file.others.map(row));
        if (!file.others.length)
          list.append(el("p", { class: "wv-quiet" }, "No config files there."));
      });
      upload.addEventListener(
        "change",
        () => upload.files?.[0] && close({ upload: upload.files[0] }),
      );
      return [
        el("p", { class: "wv-quiet" }, `In ${file.folder} of the machine that runs webviz:`),
        list,
        upload,
        textButton("Upload from this computer", () => upload.click(), {
          class: "wv-button wv-upload",
          icon: "upload",
        }),
      ];
    },
    buttons: [{ label: "Cancel", value: null }],
  }).then((chosen) => {
    end();
    if (chosen?.upload) return load(chosen.upload);
    if (chosen?.name) return replace(chosen.name, "Open", { path: chosen.name });
  });
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
  if (!file.is_changed || (await ask(question, options))) act(command, fields);
}
