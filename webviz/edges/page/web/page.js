// What viser's page does differently for us, besides drawing.

import * as viser from "./viser_page.js";

export function install() {
  // Colours as they were sent: no film curve (viser's page turns ACES on).
  Object.defineProperty(viser.gl(), "toneMapping", { get: () => 0, set: () => {} });

  // viser's word of a browser without a graphics card is on its console too; here it hides robots.
  const style = document.createElement("style");
  style.textContent = "#webgl-software-rendering { display: none; }";
  document.head.append(style);

  // Controls that go: viser's page would update them after it has removed them, if both wait for
  // the same frame, and report an error.
  viser.filterMessages((messages, waiting) => {
    for (const { type, uuid } of messages) {
      if (type !== "GuiRemoveMessage") continue;
      for (let i = waiting.length - 1; i >= 0; i--) {
        if (waiting[i].type === "GuiUpdateMessage" && waiting[i].uuid === uuid) waiting.splice(i, 1);
      }
    }
    return messages;
  });

  // Ctrl+S is a command; the camera of viser, which listens further out, would walk as well.
  document.documentElement.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) event.stopPropagation();
  });

  // The tab of the browser is called as the panel is.
  setInterval(() => {
    const panel = document.querySelector("[data-page-title]");
    if (panel) document.title = panel.dataset.pageTitle;
  }, 500);
}
