// The buttons of a recording: step, rate, loop, and the time to go to.

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { textField } from "webviz/controls/fields.js";
import { el } from "webviz/dom.js";
import { iconButton, textButton } from "webviz/icons.js";
import { openMenu } from "webviz/controls/menu.js";
import { effect } from "webviz/signals.js";
import { duration } from "webviz/time_text.js";
import { toast } from "webviz/toasts.js";
import { beforeText, isOpened, isRewound } from "webviz/moment.js";
import { returnToLive } from "webviz/features/playback/rewound.js";
import { stepMessage } from "webviz/features/playback/step.js";
import { isDate, parseTime } from "webviz/features/playback/typed_time.js";

/** @import {Readable, Signal} from "webviz/signals.js" */
/** @import {Moment} from "webviz/types.js" */
/** @import {Bookmarks} from "webviz/features/playback/bookmarks.js" */
/** @import {Seeks} from "webviz/features/playback/rewound.js" */
/** @import {Topics} from "webviz/features/playback/topics.js" */

/**
 * What buttons are about; the others are of the modules of these names.
 *
 * @typedef {{
 *   seek: Seeks, recording: Readable<Moment>, position: () => number, topic: Signal<string>,
 *   topics: Topics, bookmarks: Bookmarks,
 * }} Transport
 */

const RATES = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20];
const FULL = 0; // as fast as possible
const HELP = "Seconds, 1:02:03.4, or a date with the time of day";

const AGO_HELP = "Seconds ago, or a date with the time of day";

/** @param {number} rate */
const rateText = (rate) => (rate === FULL ? "max" : `${rate}×`);

/** @param {Moment} recording */
const isBag = (recording) => recording.get("is_live") === null;

/** @param {Transport} of */
export function transport(of) {
  const { recording, topic, topics, bookmarks } = of;
  const stays = () => isBag(recording.value);
  const steps = () => (topic.value ? `of ${topic.value}` : "of any displayed topic");
  const loop = iconButton(
    "loop",
    "Loop",
    () => act("SetLoop", { loop: !recording.value.get("loop") }),
    {
      tip: "Start over at the end of what is selected",
      hidden: () => !stays(),
      "aria-pressed": () => String(recording.value.get("loop")),
    },
  );
  const list = iconButton("list", "Topics", topics.toggle, {
    tip: "When each topic has messages",
    "aria-pressed": () => String(topics.isOpen()),
  });
  const total = () => (stays() ? `/ ${duration(recording.value.get("duration"))}` : "");
  const live = textButton("Live (L)", returnToLive, {
    class: "wv-button wv-primary wv-live",
    hidden: () => !isRewound(recording.value) && !isOpened(recording.value),
    tip: "Return to live (L)",
  });
  /**
   * @param {string} icon
   * @param {string} label
   * @param {boolean} isForward
   * @param {() => string} tip
   */
  const step = (icon, label, isForward, tip) =>
    iconButton(icon, label, () => stepMessage(topic.value, isForward), { "data-tip": tip });
  return el(
    "div",
    { class: "wv-transport" },
    ...[
      step("step-back", "Previous message", false, () => `Previous message ${steps()} (←)`),
      step("step", "Next message", true, () => `Next message ${steps()} (→)`),
    ].map((button) => needs("StepMessage", button)),
    needs("SetRate", rateButton(recording)),
    needs("SetLoop", loop),
    list,
    bookmarks.element,
    needs("Seek", el("span", { class: "wv-go" }, timeField(of))),
    el("span", { class: "wv-quiet wv-number" }, total),
    needs("ReturnToLive", live),
  );
}

/** @param {Readable<Moment>} recording */
function rateButton(recording) {
  const rate = () => recording.value.get("rate") ?? 1;
  const choose = () => {
    const { left, top } = button.getBoundingClientRect();
    const items = [...RATES, FULL].map((value) => ({
      label: value === FULL ? "As fast as possible" : rateText(value),
      checked: rate() === value,
      run: () => act("SetRate", { rate: value }),
    }));
    openMenu(left, top, items);
  };
  /** @type {HTMLButtonElement} */
  const button = el(
    "button",
    {
      type: "button",
      class: "wv-button wv-rate",
      "aria-label": "Rate",
      "data-tip": "How fast to play",
      onclick: choose,
    },
    () => rateText(rate()),
  );
  return button;
}

/**
 * The position, which can be typed, too.
 *
 * @param {Transport} of
 */
function timeField({ seek, recording, position }) {
  const help = () => (isBag(recording.value) ? HELP : AGO_HELP);
  const text = () =>
    isBag(recording.value)
      ? duration(position(), 3)
      : beforeText(position() - recording.value.get("duration"));
  const write = () => {
    const now = text();
    if (field.value !== now) field.value = now;
  };
  const go = () => {
    const typed = field.value.trim().replace(/^[-−]|\s*s$/g, "");
    const time = parseTime(typed, recording.value.get("start"));
    const isFromStart = isBag(recording.value) || isDate(typed);
    if (time !== null) seek.to(isFromStart ? time : recording.value.get("duration") - time);
    else {
      const wrong = `${field.value || "Nothing"} is not a time.`;
      toast(`${wrong} Type ${help().toLowerCase()}.`, { level: "warn" });
    }
    field.blur();
  };
  const field = textField("Go to time", {
    class: "wv-field wv-position wv-number",
    autocomplete: "off",
    spellcheck: "false",
    "data-tip": help,
    onchange: go,
    onblur: () => recording.value.size > 0 && write(),
    onfocus: (/** @type {FocusEvent & {target: HTMLInputElement}} */ { target }) => target.select(),
    onkeydown(/** @type {KeyboardEvent} */ event) {
      if (event.key === "Escape") {
        write();
        field.blur();
      } else if (event.key !== "Enter") return;
      event.stopPropagation();
    },
  });
  effect(() => {
    const now = recording.value.size ? text() : "";
    if (document.activeElement !== field && field.value !== now) field.value = now;
  });
  return field;
}
