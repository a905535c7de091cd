// Bug reports: a preview of what goes in, and the picture and selection of this page.

import { act } from "webviz/act.js";
import { el, setText } from "webviz/dom.js";
import { action } from "webviz/shell/actions.js";
import { openDialog } from "webviz/controls/dialog.js";
import { toast } from "webviz/toasts.js";
import * as selection from "webviz/tools/selection.js";
import { canvas } from "webviz/viser_page.js";
import { restore } from "webviz/features/reports/reported.js";

const QUALITY = 0.9;
const MAX_CHARACTERS = 2 << 20; // of the picture, in a message of 4 MB

export function install() {
  action({
    name: "Report a bug…",
    icon: "file",
    group: "Time",
    needs: "SaveReport",
    run: openReport,
  });
  restore();
}

/** Shows what a report would contain; saves it once that is confirmed. */
function openReport() {
  const list = el("ul", { class: "wv-report" });
  const names = el("input", { type: "checkbox", class: "wv-check", onchange: show });
  const problem = el("p", { class: "wv-problem", role: "alert" });

  async function show() {
    const { level, text } = await act(
      "ListReport",
      { with_names: names.checked },
      { quiet: true, errors: "caller" },
    );
    const isBad = level === "error";
    setText(problem, isBad ? text : "");
    list.replaceChildren(...(isBad ? [] : text.split("\n").map((line) => el("li", {}, line))));
  }

  async function save() {
    const fields = {
      picture: await picture(),
      selection: selection.sendable(selection.all().values()),
      with_names: names.checked,
    };
    setText(problem, "Saving…");
    const { level, text } = await act("SaveReport", fields, { quiet: true, errors: "caller" });
    setText(problem, level === "error" ? text : "");
    if (level !== "error") toast(text, { level });
    return level !== "error";
  }

  show();
  return openDialog({
    title: "Report a bug",
    className: "wv-report-dialog",
    content: [
      el(
        "p",
        { class: "wv-quiet" },
        "A zip file in the working folder of webviz; nothing is sent anywhere. It contains:",
      ),
      list,
      el(
        "label",
        { class: "wv-report-names" },
        names,
        "Include names of hosts, users and home folders",
      ),
      problem,
    ],
    buttons: [
      { label: "Cancel", value: null },
      { label: "Save", value: true, primary: true, accept: save },
    ],
  });
}

/** The scene as JPEG in base64, "" if it is too large. */
async function picture() {
  /** @type {Blob | null} */
  const blob = await new Promise((resolve) => canvas().toBlob(resolve, "image/jpeg", QUALITY));
  if (!blob) return "";
  const bytes = new Uint8Array(await blob.arrayBuffer());
  let text = "";
  for (let at = 0; at < bytes.length; at += 8192)
    text += String.fromCharCode(...bytes.subarray(at, at + 8192));
  const encoded = btoa(text);
  return encoded.length <= MAX_CHARACTERS ? encoded : "";
}
