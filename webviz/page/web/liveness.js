// Notice and recovery when the server falls silent.
//
// The server says something at least every second. A browser learns from its websocket alone neither
// that a server hangs nor that a radio link broke.

import * as channel from "webviz/channel.js";
import { notice } from "webviz/notice.js";
import * as viser from "webviz/viser_page.js";

const TICK_MS = 500;
const LOST_TICKS = 8;
const JOINED_MS = 8000;
const REFUSED =
  "webviz serves this page, but its websocket does not open. A proxy must forward the headers " +
  "Host, with its port, and Upgrade, and no browser extension may block websockets.";
const SILENT =
  "webviz does not answer. Check that it is running; this page connects automatically.";

/**
 * Says why, if the page has not joined the viewer in time, and takes it back once it has.
 *
 * @param {() => boolean} hasJoined
 */
export async function untilJoined(hasJoined) {
  const later = () => new Promise((resolve) => setTimeout(resolve, TICK_MS));
  const since = Date.now();
  while (!hasJoined() && Date.now() - since < JOINED_MS) await later();
  if (hasJoined()) return;
  const answer = await fetch("./", { method: "HEAD" }).catch(() => null);
  const bar = notice(answer?.ok ? REFUSED : SILENT);
  document.body.append(bar);
  viser.reveal();
  while (!hasJoined()) await later();
  bar.remove();
}

export function install() {
  // Not a clock: of a page that was busy or asleep itself, the time does not count.
  let ticks = 0;
  let heard = 0; // when, in ms; 0 before the page has joined
  const banner = lostBanner();
  function hear() {
    [ticks, heard] = [0, Date.now()];
    banner.hide();
  }
  channel.on("Heartbeat", hear);
  channel.on("Dismissed", ({ text }) => leave(text));
  viser.filterMessages((messages) => {
    hear();
    return messages;
  });
  // viser's page looks for its server only while it has the focus; on a second screen it has not.
  document.hasFocus = () => true;
  setInterval(() => {
    if (!heard) return;
    ticks += 1;
    if (ticks < LOST_TICKS) return;
    if (ticks % LOST_TICKS === 0) askAgain();
    banner.show(Date.now() - heard);
  }, TICK_MS);
  channel.onClose(askAgain);
}

/**
 * Shows a text in place of the page: viser's would connect again, so it has to go.
 *
 * @param {string} text as HTML
 */
function leave(text) {
  const page = `<!doctype html><meta charset="utf-8"><title>webviz</title><p>${text}`;
  location.replace(URL.createObjectURL(new Blob([page], { type: "text/html" })));
}

/** The server may have revoked the token of this page; it then says so instead of this page. */
async function askAgain() {
  const answer = await fetch("./", { method: "HEAD" }).catch(() => null);
  if (answer?.status === 403 || answer?.status === 404) location.reload();
}

function lostBanner() {
  const banner = notice();
  banner.id = "webviz-contact";
  return {
    hide() {
      if (!banner.isConnected) return;
      banner.remove();
      document.body.classList.remove("wv-lost");
    },
    /** @param {number} ms since the server was heard */
    show(ms) {
      banner.textContent =
        `Connection to webviz lost. The picture is ${ageText(ms / 1000)} old. ` +
        "Check that webviz is running; this page reconnects automatically.";
      if (banner.isConnected) return;
      document.body.append(banner);
      document.body.classList.add("wv-lost");
    },
  };
}

/** @param {number} age in seconds */
function ageText(age) {
  const seconds = Math.round(age);
  if (seconds < 120) return `${seconds} s`;
  return seconds < 7200 ? `${Math.round(seconds / 60)} min` : `${Math.round(seconds / 3600)} h`;
}
