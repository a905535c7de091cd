// Changes to viser's page, besides drawing.

import * as viser from "./viser_page.js";

export function install() {
  // Colours as they were sent: no film curve (viser's page turns ACES on).
  Object.defineProperty(viser.gl(), "toneMapping", { get: () => 0, set: () => {} });

  // Ctrl+S is a command; the camera of viser, which listens further out, would walk as well.
  document.documentElement.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) event.stopPropagation();
  });
}
