// Saves what the page shows.

import * as channel from "webviz/channel.js";
import * as viser from "webviz/viser_page.js";

/** @param {{name: string}} message */
function save({ name }) {
  /** @param {number} number */
  const pad = (number) => String(number).padStart(2, "0");
  const now = new Date();
  const day = [now.getFullYear(), pad(now.getMonth() + 1), pad(now.getDate())].join("-");
  const time = [now.getHours(), now.getMinutes(), now.getSeconds()].map(pad).join(".");
  viser.canvas().toBlob((blob) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(/** @type {Blob} */ (blob));
    link.download = name || `webviz ${day} ${time}.png`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  }, "image/png");
}

export function install() {
  channel.on("SaveCanvas", save);
}
