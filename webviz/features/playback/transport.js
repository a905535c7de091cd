// The buttons of a recording: step, rate, loop, and the time to go to.

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { textField } from "webviz/controls/fields.js";
import { el, set, setText } from "webviz/dom.js";
import { iconButton, textButton } from "webviz/icons.js";
import { openMenu } from "webviz/controls/menu.js";
import { duration } from "webviz/time_text.js";
import { toast } from "webviz/toasts.js";
import { beforeText, isOpened, isRewound } from "webviz/moment.js";
import { returnToLive } from "webviz/features/playback/rewound.js";
import { isDate, parseTime } from "webviz/features/playback/typed_time.js";

/** @import {Moment} from "webviz/types.js" */
/** @import {Bookmarks} from "webviz/features/playback/bookmarks.js" */
/** @import {Seeks} from "webviz/features/playback/rewound.js" */
/** @import {Topics} from "webviz/features/playback/topics.js" */

const RATES = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20];
const FULL = 0; // as fast as possible
const HELP = "Seconds, 1:02:03.4, or a date with the time of day";

const AGO_HELP = "Seconds ago, or a date with the time of day";

/** @param {number} rate */
const rateText = (rate) => (rate === FULL ? "max" : `${rate}×`);

/**
 * Returns `{element, show(recording, position)}`; the others are of the modules of these names.
 *
 * @param {Seeks} seek
 * @param {{topic(): string, run(isForward: boolean): unknown}} step
 * @param {Topics} topics
 * @param {Bookmarks} bookmarks
 */
export function transport(seek, step, topics, bookmarks) {
  /** @type {Moment} */
  let recording = new Map();

  /**
   * @param {string} label
   * @param {string} name
   * @param {string} tip
   * @param {() => unknown} onclick
   */
  const button = (name, label, tip, onclick) => iconButton(name, label, onclick, { tip });
  const before = button("step-back", "Previous message", "", () => step.run(false));
  const after = button("step", "Next message", "", () => step.run(true));
  const rate = el("button", {
    type: "button",
    class: "wv-button wv-rate",
    "aria-label": "Rate",
    "data-tip": "How fast to play",
    onclick: chooseRate,
  });
  const loop = button("loop", "Loop", "Start over at the end of what is selected", () =>
    act("SetLoop", { loop: !recording.get("loop") }),
  );
  const list = button("list", "Topics", "When each topic has messages", topics.toggle);
  const field = textField("Go to time", {
    class: "wv-field wv-position wv-number",
    autocomplete: "off",
    spellcheck: "false",
    "data-tip": HELP,
    onchange: go,
    onblur: () => recording.size > 0 && write(),
    onfocus: (/** @type {FocusEvent & {target: HTMLInputElement}} */ { target }) => target.select(),
    onkeydown: key,
  });
  const length = el("span", { class: "wv-quiet wv-number" });
  const live = textButton("Live (L)", returnToLive, {
    class: "wv-button wv-primary wv-live",
    hidden: true,
    tip: "Return to live (L)",
  });
  const element = el(
    "div",
    { class: "wv-transport" },
    needs("StepMessage", before),
    needs("StepMessage", after),
    needs("SetRate", rate),
    needs("SetLoop", loop),
    list,
    bookmarks.element,
    needs("Seek", el("span", { class: "wv-go" }, field)),
    length,
    needs("ReturnToLive", live),
  );
  let shown = 0;
  const isBag = () => recording.get("is_live") === null;

  function chooseRate() {
    const { left, top } = rate.getBoundingClientRect();
    const items = [...RATES, FULL].map((value) => ({
      label: value === FULL ? "As fast as possible" : rateText(value),
      checked: recording.get("rate") === value,
      run: () => act("SetRate", { rate: value }),
    }));
    openMenu(left, top, items);
  }

  /** @param {KeyboardEvent} event */
  function key(event) {
    if (event.key === "Escape") {
      write();
      field.blur();
    } else if (event.key !== "Enter") return;
    event.stopPropagation();
  }

  function go() {
    const text = field.value.trim().replace(/^[-−]|\s*s$/g, "");
    const time = parseTime(text, recording.get("start"));
    const help = isBag() ? HELP : AGO_HELP;
    if (time === null)
      toast(`${field.value || "Nothing"} is not a time. Type ${help.toLowerCase()}.`, {
        level: "warn",
      });
    else seek.to(isBag() || isDate(text) ? time : recording.get("duration") - time);
    field.blur();
  }

  const write = () => {
    const text = isBag() ? duration(shown, 3) : beforeText(shown - recording.get("duration"));
    if (field.value !== text) field.value = text;
  };

  /**
   * @param {Moment} next
   * @param {number} position
   */
  function show(next, position) {
    recording = next;
    shown = position;
    if (document.activeElement !== field) write();
    setText(length, isBag() ? `/ ${duration(recording.get("duration"))}` : "");
    set(field, { "data-tip": isBag() ? HELP : AGO_HELP });
    set(loop, { hidden: !isBag() });
    set(bookmarks.element, { hidden: !isBag() && !isRewound(recording) });
    set(live, { hidden: !isRewound(recording) && !isOpened(recording) });
    setText(rate, rateText(recording.get("rate")));
    set(loop, { "aria-pressed": String(recording.get("loop")) });
    set(list, { "aria-pressed": String(topics.isOpen()) });
    const of = step.topic() ? `of ${step.topic()}` : "of any displayed topic";
    set(before, { "data-tip": `Previous message ${of} (←)` });
    set(after, { "data-tip": `Next message ${of} (→)` });
  }

  return { element, show };
}
