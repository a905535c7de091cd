// Seeks, one at a time; a banner over the scene while the page shows the past of live topics, or a recording instead of them, and
// what returns to live.

import { why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { wallNow } from "webviz/clock.js";
import { el, set, setText } from "webviz/dom.js";
import { sanitized } from "webviz/sanitize.js";
import { command } from "webviz/commands.js";
import { newest } from "webviz/newest.js";
import { setTitlePrefix } from "webviz/title.js";
import { store, watch } from "webviz/stores.js";
import { agoText, atMoment, isOpened, isRewound } from "webviz/moment.js";
import { savedText } from "webviz/time_text.js";

/** @import {ValuesOf} from "webviz/types.js" */

const TICK_MS = 100;
const COARSE = matchMedia("(pointer: coarse)");

export const returnToLive = () => act("ReturnToLive");

/** @typedef {ReturnType<typeof seeks>} Seeks */

/**
 * Returns `{to(time), wanted()}`, as of `newest.js`: `to` shows a time of the recording.
 *
 * @param {() => void} changed
 * @param {(time: number) => boolean} isNow whether a time is that of live topics
 */
export const seeks = (changed, isNow = () => false) =>
  newest((time) => (isNow(time) ? returnToLive() : act("Seek", { at_s: time })), changed);

/**
 * Return who looks back, if that is another page; "" if it is this one or a program.
 *
 * @param {ValuesOf<"playback">} values
 */
function leaderText(values) {
  const leader = values.get("leader") ?? null;
  if (leader === null || leader === window.webviz.browser) return "";
  const name = store("people").get(String(leader))?.name;
  return `${sanitized(name || "Another page")} looks back · `;
}

/** The banner; hidden while topics are live. */
export function banner() {
  /** @type {ValuesOf<"playback"> | null} */
  let values = null;
  let timer = 0;
  const ago = el("span", { class: "wv-number" });
  const how = el("span");
  const element = el(
    "button",
    {
      type: "button",
      class: "wv-rewound-banner",
      hidden: true,
      "aria-live": "polite",
      onclick: returnToLive,
    },
    ago,
    how,
  );

  function tick() {
    if (!values) return;
    if (isOpened(values)) {
      setText(
        ago,
        `Recording ${sanitized((values.get("names") ?? []).map(savedText).join(", "))} · not live`,
      );
      setTitlePrefix("Recording · ");
      return;
    }
    const shown = atMoment(values, wallNow());
    setText(ago, `${leaderText(values)}${agoText(shown.get("ago"))} · not live`);
    setTitlePrefix(`${shown.get("ago").toFixed(0)} s ago · `);
  }

  watch("playback", (next) => {
    values = next;
    const isPast = isRewound(next) || isOpened(next);
    const wasPast = !element.hidden;
    clearInterval(timer);
    document.body.classList.toggle("wv-rewound", isPast);
    set(element, { hidden: !isPast });
    if (wasPast && !isPast) setTitlePrefix("");
    if (!isPast) return;
    setText(how, why("ReturnToLive") ? "" : ` · ${COARSE.matches ? "tap" : "press L"} to return`);
    tick();
    timer = setInterval(tick, TICK_MS);
  });
  command({
    name: "Return to live",
    icon: "step",
    key: "l",
    group: "Time",
    needs: "ReturnToLive",
    isThere: () => isRewound(values) || isOpened(values),
    run: returnToLive,
  });
  return element;
}
