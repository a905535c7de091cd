// One's own past: a page that looks back asks for whom, and goes to a viewer of its own meanwhile.

import { why } from "webviz/access.js";
import { act, detour } from "webviz/act.js";
import { wallNow } from "webviz/clock.js";
import { command } from "webviz/commands.js";
import { openDialog } from "webviz/controls/dialog.js";
import { el } from "webviz/dom.js";
import { overlay } from "webviz/overlay/overlay.js";
import { recallInTab, rememberInTab, resumeAs } from "webviz/remember.js";
import { once, store } from "webviz/stores.js";
import { atMoment } from "webviz/moment.js";
import { setTitlePrefix } from "webviz/title.js";
import { effect } from "webviz/signals.js";

/** @import {Answer} from "webviz/act.js" */

const CHOICE = "webviz.looks_back"; // of this tab, in its session
const BEFORE_S = 0.5; // for a step back, which has no time of its own

export function install() {
  overlay("scene", "own past", banner());
  command({
    name: "Back to live",
    icon: "step",
    key: "l",
    group: "Time",
    isThere: isOwn,
    run: backToLive,
  });
  command({
    name: "Look back for me only",
    icon: "step-back",
    group: "Time",
    needs: "LookBackAlone",
    isThere: () => canOpen() && isLive(),
    run: () => lookBackAlone(null),
  });
  // Read all the time, so that they are there for a look back.
  effect(() => [store("people").all().size, canOpen(), isLive()]);
  detour("Seek", ({ at_s }) => choose("Seek", { at_s }, at_s));
  detour("StepMessage", (fields) => choose("StepMessage", fields, null));
}

const isOwn = () => store("own_past").get("is_own") === true;
const canOpen = () => store("own_past").get("can_open") === true;
const isLive = () => store("playback").get("is_live") === true;
const backToLive = () => goTo("../../");

/** @param {string} address relative to this page, which comes back as it was */
function goTo(address) {
  const target = new URL(address, location.href);
  const live = isOwn() ? target.pathname : location.pathname;
  resumeAs(live);
  location.assign(target);
}

/** Over the scene of a page that looks back on its own; a click returns to live. */
function banner() {
  effect(() => setTitlePrefix(isOwn() ? "Own past · " : ""));
  effect(() => document.body.classList.toggle("wv-own-past", isOwn()));
  return el(
    "button",
    {
      type: "button",
      class: "wv-own-past-banner",
      hidden: () => !isOwn(),
      "data-tip": "All others stay live. This view ends when its page is closed",
      "data-key": "l",
      onclick: backToLive,
    },
    "Your own past · ",
    el("u", {}, "Back to live"),
  );
}

/**
 * Asks for whom to look back; null if there is nothing to ask, and it is for everybody.
 *
 * @param {"Seek" | "StepMessage"} name
 * @param {any} fields
 * @param {number | null} at
 * @returns {Promise<Answer> | null}
 */
function choose(name, fields, at) {
  const others = store("people").all().size - 1;
  if (!isLive() || !canOpen() || others < 1 || why("LookBackAlone")) return null;
  const chosen = recallInTab(CHOICE);
  if (chosen === "everybody") return null;
  if (chosen === "me") return lookBackAlone(at);
  return ask(others).then((choice) => {
    if (choice === "me") return lookBackAlone(at);
    if (choice === "everybody") return act(name, fields, { isDirect: true });
    return { level: "error", text: "" };
  });
}

/**
 * @param {number} others pages
 * @returns {Promise<"me" | "everybody" | null>}
 */
async function ask(others) {
  const again = el("input", { type: "checkbox" });
  const who = others === 1 ? "Another page shows" : `${others} other pages show`;
  const choice = await openDialog({
    title: "Look back for whom?",
    content: [
      el(
        "p",
        {},
        `${who} this viewer. For everybody, all see the past, and nothing is sent to the robot.`,
      ),
      el("p", {}, "For me, this page alone looks back, and all others stay live."),
      el("label", { class: "wv-own-past-again" }, again, "Don't ask again in this tab"),
    ],
    buttons: [
      { label: "Cancel", value: null },
      { label: "For everybody", value: "everybody" },
      { label: "For me", value: "me", primary: true, focused: true },
    ],
  });
  if (choice && again.checked) rememberInTab(CHOICE, choice);
  return choice;
}

/**
 * Goes to a viewer of this page's own.
 *
 * @param {number | null} at seconds; null is just before now
 * @returns {Promise<Answer>}
 */
async function lookBackAlone(at) {
  const moment = await once("playback", (values) => atMoment(values, wallNow()));
  const at_s = at ?? moment.get("duration") - BEFORE_S;
  const answer = await act("LookBackAlone", { at_s }, { quiet: true });
  if (answer.address) goTo(answer.address);
  return { level: answer.level, text: "" };
}
