// The timeline of a recording: a track over the bar of the time, and buttons within it.

import { act } from "webviz/act.js";
import { wallNow } from "webviz/clock.js";
import { copy } from "webviz/clipboard.js";
import { provide } from "webviz/commands.js";
import { toast } from "webviz/toasts.js";
import { store, watch } from "webviz/stores.js";
import { bookmarks as bookmarkMenu } from "webviz/features/playback/bookmarks.js";
import { timeCommands } from "webviz/features/playback/commands.js";
import { byTime } from "webviz/features/playback/events.js";
import { atMoment, behindAt, isNow, isRewound } from "webviz/moment.js";
import { shownLength } from "webviz/features/playback/range.js";
import { seeks } from "webviz/features/playback/rewound.js";
import { topics as topicList } from "webviz/features/playback/topics.js";
import { track as makeTrack } from "webviz/features/playback/track.js";
import { transport as makeTransport } from "webviz/features/playback/transport.js";
import { parseTime } from "webviz/features/playback/typed_time.js";

/** @import {LoggedEvent, Moment, Range, ValuesOf} from "webviz/types.js" */

/** @import {Timeline, TimelinePlaces} from "webviz/shell/time_bar.js" */

const TICK_MS = 200;

/**
 * Puts a track and buttons into elements while there is a past; `toggle` plays or pauses.
 *
 * @param {TimelinePlaces} places
 * @returns {Timeline}
 */
export function timeline(places) {
  /** @type {ValuesOf<"playback"> | null} */
  let values = null;
  /** @type {Moment} */
  let recording = new Map(); // at this moment; empty without one
  let timer = 0;
  let topic = ""; // of which the next message is shown, "" for all that are displayed

  const clock = store("clock");
  const position = () => seek.wanted() ?? recording.get("position");
  const seek = seeks(show, (time) => recording.size > 0 && isNow(recording, time, track.length()));
  const step = {
    topic: () => topic,
    /** @param {string} next */
    choose(next) {
      topic = next;
      show();
    },
    /** @param {boolean} isForward */
    run: (isForward) => act("StepMessage", { topic, is_forward: isForward }),
  };
  const track = makeTrack(seek, () => topics.redraw());
  const topics = topicList({
    range: track.range,
    counted: track.counted,
    step,
    toggled: () => show(),
  });
  const bookmarks = bookmarkMenu(seek, position);
  const buttons = makeTransport(seek, step, topics, bookmarks);
  /** @type {LoggedEvent[]} */
  let events = [];
  /** @type {(() => void)[]} */
  let ends = [];

  function show() {
    if (!values) return;
    recording = atMoment(values, wallNow(), behindAt(clock, wallNow()));
    track.show(recording);
    buttons.show(recording, position());
  }

  /** @param {boolean} isThere */
  function appear(isThere) {
    document.body.classList.toggle("wv-recording", isThere);
    clearInterval(timer);
    places.track.replaceChildren(...(isThere ? [topics.element, track.element] : []));
    places.buttons.replaceChildren(...(isThere ? [buttons.element] : []));
    for (const end of ends.splice(0)) end();
    if (!isThere) return;
    if (!isBag()) timer = setInterval(() => document.hidden || show(), TICK_MS);
    ends = [
      watch("density", (density) => {
        const [first, last] = [density.get("first") ?? 0, density.get("last") ?? 0];
        const counted = /** @type {Range} */ ([first, first + shownLength(last - first)]);
        track.mark({ counts: density.get("counts") ?? [], counted });
      }),
      watch("bookmarks", (known) => {
        bookmarks.show(known.get("all") ?? []);
        track.mark({ bookmarks: known.get("all") ?? [] });
      }),
      watch("events", (known) => {
        events = byTime(known);
        track.mark({ events });
      }),
    ];
    if (isBag()) begin();
  }

  // A link may name a moment: once, since people go on from there.
  function begin() {
    const address = new URL(location.href);
    const text = address.searchParams.get("t");
    if (text === null) return;
    address.searchParams.delete("t");
    history.replaceState(history.state, "", address);
    const time = parseTime(text, recording.get("start"));
    if (time === null) toast(`The link has an invalid time: t=${text}.`, { level: "warn" });
    else seek.to(time);
  }

  async function copyLink() {
    const address = new URL(location.pathname, location.href);
    address.searchParams.set("t", position().toFixed(3));
    const isCopied = await copy(address.href);
    toast(
      isCopied ? "Copied the link to this moment." : `The link to this moment: ${address.href}`,
    );
  }

  const isBag = () => values?.get("is_live") === null;
  /** @param {ValuesOf<"playback"> | null} recording */
  const nameOf = (recording) => (recording?.get("names") ?? []).join();

  watch("playback", (next) => {
    const isThere = next.has("start");
    const isNew = isThere !== (values !== null) || nameOf(next) !== nameOf(values);
    values = isThere ? next : null;
    recording = isThere ? atMoment(next, wallNow()) : new Map();
    if (isNew) appear(isThere);
    show();
  });

  const { ofRecordings, ofBags, ofLive, ofAll } = timeCommands({
    recording: () => recording,
    seek,
    position,
    events: () => events,
    play: places.toggle,
    step: step.run,
    addBookmark: bookmarks.add,
    copyLink,
    showTopics: topics.toggle,
  });
  provide(() => {
    if (!values) return [];
    if (isBag()) return [...ofRecordings, ...ofBags, ...ofAll];
    return [...(isRewound(values) ? ofRecordings : ofLive), ...ofAll];
  });

  return {
    isThere: () => isBag() || isRewound(values),
    isPast: () => values !== null && (!isBag() || values.get("is_memory") === true),
    names: () => (isBag() ? (values?.get("names") ?? []).join(", ") : null),
  };
}
