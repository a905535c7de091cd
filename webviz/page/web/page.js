// Changes to the page of viser as a whole.

import * as viser from "webviz/viser_page.js";

export function install() {
  viser.drawOnceShown();
  // Colours as they were sent: no film curve (viser's page turns ACES on).
  Object.defineProperty(viser.gl(), "toneMapping", { get: () => 0, set: () => {} });
}
