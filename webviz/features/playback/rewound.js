// Seeks, one at a time; a banner over the scene while the page shows the past of live topics, or a recording instead of them, and
// what returns to live.

import { why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { wallNow } from "webviz/clock.js";
import { el } from "webviz/dom.js";
import { sanitized } from "webviz/sanitize.js";
import { command } from "webviz/commands.js";
import { newest } from "webviz/newest.js";
import { setTitlePrefix } from "webviz/title.js";
import { computed, effect, owned, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { every } from "webviz/timing.js";
import { agoText, atMoment, isOpened, isRewound } from "webviz/moment.js";
import { savedText } from "webviz/time_text.js";

const TICK_MS = 100;
const COARSE = matchMedia("(pointer: coarse)");

const playback = store("playback");
const people = store("people");

export const returnToLive = () => act("ReturnToLive");

/** @typedef {ReturnType<typeof seeks>} Seeks */

/**
 * Returns `{to(time), wanted()}`, as of `newest.js`: `to` shows a time of the recording.
 *
 * @param {(time: number) => boolean} isNow whether a time is that of live topics
 */
export const seeks = (isNow) =>
  newest((time) => (isNow(time) ? returnToLive() : act("Seek", { at_s: time })));

/** Return who looks back, if that is another page; "" if it is this one or a program. */
function leaderText() {
  const leader = playback.get("leader") ?? null;
  if (leader === null || leader === window.webviz.browser) return "";
  const name = people.get(String(leader))?.name;
  return `${sanitized(name || "Another page")} looks back · `;
}

/** The banner; hidden while topics are live. */
export function banner() {
  const isPast = computed(() => isRewound(playback) || isOpened(playback));
  const ticks = signal(0);
  const ago = computed(() =>
    isPast.value && !isOpened(playback) && ticks.value >= 0
      ? Number(atMoment(playback.all(), wallNow()).get("ago"))
      : 0,
  );
  effect(() => {
    document.body.classList.toggle("wv-rewound", isPast.value);
    if (!isPast.value) return;
    every(TICK_MS, () => (ticks.value += 1));
    owned(() => setTitlePrefix(""));
  });
  effect(() => {
    if (!isPast.value) return;
    setTitlePrefix(isOpened(playback) ? "Recording · " : `${ago.value.toFixed(0)} s ago · `);
  });
  command({
    name: "Return to live",
    icon: "step",
    key: "l",
    group: "Time",
    needs: "ReturnToLive",
    isThere: () => isPast.value,
    run: returnToLive,
  });
  const names = () => sanitized((playback.get("names") ?? []).map(savedText).join(", "));
  const text = () =>
    isOpened(playback) ? `Recording ${names()}` : `${leaderText()}${agoText(ago.value)}`;
  const how = () =>
    why("ReturnToLive") ? "" : ` · ${COARSE.matches ? "tap" : "press L"} to return`;
  return el(
    "button",
    {
      type: "button",
      class: "wv-rewound-banner",
      hidden: () => !isPast.value,
      "aria-live": "polite",
      onclick: returnToLive,
    },
    el("span", { class: "wv-number" }, () => (isPast.value ? `${text()} · not live` : "")),
    el("span", {}, () => (isPast.value ? how() : "")),
  );
}
