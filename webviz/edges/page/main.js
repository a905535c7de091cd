// Starts the modules, once viser's page is there, and then opens the channel.

import * as channel from "./channel.js";

let installing = null;

/** Connects the page to the server that told it its key. */
export async function connect({ key, browser, constants }, folder) {
  installing ??= install(constants);
  await installing;
  window.webviz.browser = browser;
  channel.open(`${folder.replace(/^http/, "ws")}channel`, key);
}

async function install() {
  const answer = (token) => channel.send({ type: "Answer", token });
  channel.on("Ask", ({ token }) => answer(token));
  window.webviz.answer = answer;
  window.webviz.answers.splice(0).forEach(answer);
}
