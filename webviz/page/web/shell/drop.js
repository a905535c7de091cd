// A file that is dropped on the page.

import { el } from "webviz/dom.js";
import { load } from "webviz/shell/opening.js";

/** @param {HTMLElement} page */
export function install(page) {
  const cover = el(
    "div",
    { class: "wv-file-drop", hidden: true },
    el("p", {}, "Drop a config, a bag or a report to open it"),
  );
  page.append(cover);
  /** @param {DragEvent} event */
  const hasFiles = ({ dataTransfer }) => [...(dataTransfer?.types ?? [])].includes("Files");
  /**
   * @param {"dragenter" | "dragover" | "dragleave" | "drop"} name
   * @param {(event: DragEvent) => void} act
   */
  const on = (name, act) =>
    window.addEventListener(name, (event) => hasFiles(event) && act(event), true);
  on("dragenter", () => (cover.hidden = false));
  on("dragover", (event) => event.preventDefault());
  on("dragleave", (event) => {
    // Out of the window, not into another element of it.
    if (event.relatedTarget === null) cover.hidden = true;
  });
  on("drop", (event) => {
    event.preventDefault();
    event.stopPropagation();
    cover.hidden = true;
    const [file] = event.dataTransfer?.files ?? [];
    if (file && !document.querySelector("dialog[open]")) load(file);
  });
}
