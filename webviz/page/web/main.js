// Starts the modules as viser's page comes about, and opens the channel when the server calls.

import { decideBy } from "webviz/access.js";
import * as batches from "webviz/scene/batches.js";
import * as blocks from "webviz/scene/blocks.js";
import * as channel from "webviz/channel.js";
import { about } from "webviz/recorded/chunks.js";
import { connection, refusal } from "webviz/recorded/connection.js";
import * as colors from "webviz/scene/colors.js";
import constants from "webviz/constants.js";
import * as liveness from "webviz/liveness.js";
import { hasWebGL } from "webviz/scene/graphics.js";
import * as flat from "webviz/scene/flat.js";
import * as capacity from "webviz/scene/capacity.js";
import * as inStep from "webviz/scene/in_step.js";
import * as labels from "webviz/scene/labels.js";
import * as lines from "webviz/scene/lines.js";
import * as fingers from "webviz/scene/fingers.js";
import * as mouse from "webviz/scene/mouse.js";
import { notice } from "webviz/notice.js";
import * as overlay from "webviz/overlay/overlay.js";
import * as page from "webviz/page.js";
import * as points from "webviz/scene/points.js";
import * as pieces from "webviz/scene/pieces.js";
import * as saveImage from "webviz/scene/save_image.js";
import * as scheme from "webviz/scene/scheme.js";
import * as shade from "webviz/scene/shade.js";
import * as shell from "webviz/shell/shell.js";
import * as textures from "webviz/scene/textures.js";
import * as tiles from "webviz/scene/tiles.js";
import * as theme from "webviz/shell/theme.js";
import * as toolbar from "webviz/shell/toolbar.js";
import * as view from "webviz/scene/view.js";
import * as viser from "webviz/viser_page.js";
import * as vitals from "webviz/scene/vitals.js";
import * as whole from "webviz/scene/whole.js";

/** @import {About} from "webviz/recorded/types.js" */

// Before viser's page handles the first messages: it draws with what it has then.
async function install() {
  const features = Promise.all(constants.FEATURES.map(load)); // meanwhile, and not one by one
  await viser.until(viser.hasScene);
  const ofScene = [
    scheme,
    batches,
    textures,
    tiles,
    labels,
    lines,
    points,
    shade,
    colors,
    flat,
    whole,
    pieces,
  ];
  for (const part of [shell, page, inStep, ...ofScene]) part.install();
  if (!isExported) liveness.install();
  await viser.until(() => viser.hasCamera() && viser.node(constants.ROOT));
  for (const part of [view, mouse, fingers, saveImage, overlay, capacity, blocks]) part.install();
  if (!isExported) vitals.install();
  toolbar.install(shell.places);
  for (const feature of await features) {
    try {
      feature?.install();
    } catch (error) {
      console.error(error); // one may fail without the others
    }
  }
}

/**
 * @param {string} module of a feature
 * @returns {Promise<{install(): void} | null>} null if it is broken
 */
async function load(module) {
  try {
    return await import(`webviz/${module}`);
  } catch (error) {
    console.error(error);
    return null;
  }
}

/** @param {About | null} run what is recorded, null if it cannot be read */
async function play(run) {
  decideBy(refusal);
  const feed = await viser.connectToNothing();
  if (!run) return showMessage(DAMAGED);
  const { socket, open } = connection(run, feed, (error) => {
    console.info(error);
    showMessage(DAMAGED);
  });
  await installed;
  window.webviz.browser = 0;
  channel.open(socket, "");
  open();
}

const NO_WEBGL =
  "webviz needs WebGL 2, which this browser does not support. Switch on hardware acceleration in " +
  "its settings, or use another browser.";
const DAMAGED =
  "This file is damaged, and shows only a part of its recording. Copy or export it again.";

/** @param {string} text */
function showMessage(text) {
  if (!document.querySelector(".wv-contact")) document.body.append(notice(text));
  viser.reveal();
}

/** @param {string} token */
const answer = (token) => channel.send({ type: "SyncReply", token });
channel.on("SyncRequest", ({ token }) => answer(token));

/** @type {About | null} */
const run = window.webvizRun ? about() : null;
const isExported = Boolean(window.webvizRun);
theme.install();
const installed = install();
if (isExported) play(run);
else viser.connectToFolder();
const address = new URL("webviz/channel", location.href).href.replace(/^http/, "ws");

// Functions that the server and the pictures of webviz call.
window.webviz = {
  /** viser's id of this page, once it is connected. */
  browser: null,
  answer,
  probe: vitals.probe,
  async connect({ browser, key, version }) {
    // The server was replaced by one that has other modules.
    if (version !== constants.VERSION) return location.reload();
    await installed;
    window.webviz.browser = browser;
    channel.open(new WebSocket(address), key);
  },
  hasView: () => view.type() !== "",
  pick: mouse.pick,
};
if (!isExported) liveness.untilJoined(() => window.webviz.browser !== null);
if (!hasWebGL()) showMessage(NO_WEBGL); // viser's page stays empty, and nothing else is installed
window.webvizStarted();
