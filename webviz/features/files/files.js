// The config file: its name in the head, saving, opening, downloading.

import { act } from "webviz/act.js";
import * as channel from "webviz/channel.js";
import { textField } from "webviz/controls/fields.js";
import { el, setText } from "webviz/dom.js";
import { icon, textButton } from "webviz/icons.js";
import { each, effect, root } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { ask, openDialog } from "webviz/controls/dialog.js";
import { openMenuBelow } from "webviz/controls/menu.js";
import { download } from "webviz/download.js";
import { checkedName, hasSuffix, SUFFIXES } from "webviz/features/files/file_names.js";
import { command } from "webviz/commands.js";
import { item, menuStart } from "webviz/shell/actions.js";
import { headStart } from "webviz/shell/header.js";
import { endings, fileLoader, load, sections } from "webviz/shell/opening.js";
import { setTitle } from "webviz/title.js";
import { toast } from "webviz/toasts.js";

/** @import {Close} from "webviz/controls/dialog.js" */
/** @import {Command} from "webviz/commands.js" */
/** @import {MenuItem} from "webviz/controls/menu.js" */
/** @import {Commands} from "webviz/messages.js" */

const MAX_BYTES = 2 << 20;
const MAX_CHARACTERS = (3 << 20) - 1000; // of a message with the config in it
const NEW_NAME = "webviz.yaml";

const file = store("file");

/**
 * The last part of a path.
 *
 * @param {string} path
 */
const baseName = (path) => path.slice(path.lastIndexOf("/") + 1);
/** The name of the file, "" if there is none; read in effects, as all that follows. */
const fileName = () => baseName(path());
const path = () => file.get("path") ?? "";
const isChanged = () => file.get("is_changed") ?? false;
/** True once the server has reported the file. */
const isThere = () => typeof file.get("folder") === "string";
const others = () => file.get("others") ?? [];

/** @type {Record<string, Command & {icon: string}>} */
const actions = {
  save: {
    name: "Save",
    icon: "save",
    key: "Ctrl+s",
    inFields: true,
    needs: "Save",
    run: () => save(),
  },
  saveAs: {
    name: "Save as…",
    icon: "save",
    key: "Ctrl+Shift+s",
    inFields: true,
    needs: "Save",
    run: () => saveAs(),
  },
  open: {
    name: "Open…",
    icon: "folder",
    key: "Ctrl+o",
    inFields: true,
    needs: "Open",
    run: () => open(),
  },
  yaml: { name: "Download as YAML", icon: "download", run: () => exportAs("yaml") },
  rviz: { name: "Download as .rviz", icon: "download", run: () => exportAs("rviz") },
};

/** @returns {(MenuItem | null)[]} */
const menu = () => [
  item(actions.save),
  item(actions.saveAs),
  item(actions.open),
  null,
  item(actions.yaml),
  item(actions.rviz),
];

export function install() {
  channel.on("Download", ({ name, text }) => download(name, text));
  for (const action of Object.values(actions)) command(Object.assign(action, { group: "File" }));
  menuStart(menu);
  fileLoader([...SUFFIXES, ""], loadConfig);
  headStart(nameButton(), changedMark());
  effect(() => {
    const title = [fileName(), "webviz"].filter(Boolean).join(" · ");
    if (isThere()) setTitle(isChanged() ? `* ${title}` : title);
  });
}

function nameButton() {
  /** @type {HTMLButtonElement} */
  const name = el(
    "button",
    {
      type: "button",
      class: "wv-file",
      "aria-haspopup": "menu",
      "data-tip": () => (isThere() ? path() || "Not yet saved in a file" : null),
      onclick: () => openMenuBelow(name, menu()),
    },
    () => (isThere() ? fileName() || "webviz" : "Connecting…"),
  );
  return name;
}

const changedMark = () =>
  el("span", {
    class: "wv-mark",
    role: "img",
    "aria-label": "Unsaved changes",
    "data-tip": "Unsaved changes",
    hidden: () => !isChanged(),
  });

const save = () => (path() ? act("Save") : saveAs());

/**
 * Sends the config here, as "yaml" or "rviz".
 *
 * @param {"yaml" | "rviz"} suffix
 */
const exportAs = (suffix) =>
  act("Export", { name: `${(fileName() || NEW_NAME).replace(/\.[^.]*$/, "")}.${suffix}` });

function saveAs() {
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
    // A file that this page does not know of yet is not replaced.
    if (value === "save")
      act("Save", { path: name, replace: name === confirmed || name === fileName() });
    if (value === "download") act("Export", { name });
  });
}

const open = () =>
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
    accept: endings().join(","),
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
    ...sections(close),
    upload,
    textButton("Upload from this computer", () => upload.click(), {
      class: "wv-button wv-upload",
      icon: "upload",
    }),
  ];
}

/**
 * Opens a config of this computer, or reports that a file is none.
 *
 * @param {File} upload
 */
async function loadConfig(upload) {
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
  if (!isChanged() || (await ask(question, options))) act(command, fields);
}
