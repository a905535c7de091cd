// A note of what the server has reduced because the link to this page is slow.

import * as channel from "webviz/channel.js";
import { el, showText } from "webviz/dom.js";

export function build() {
  const note = el("output", { class: "wv-card wv-slow-link", hidden: true });
  channel.on("SlowLink", ({ text }) => show(text));
  channel.onClose(() => show(""));

  /** @param {string} text */
  function show(text) {
    showText(note, text);
  }
  return note;
}
