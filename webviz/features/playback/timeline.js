// The timeline of a recording: a track over the bar of the time, and buttons within it.

import { wallNow } from "webviz/clock.js";
import { copy } from "webviz/clipboard.js";
import { provide } from "webviz/commands.js";
import { toast } from "webviz/toasts.js";
import { store } from "webviz/stores.js";
import { computed, effect, owned, signal, untracked } from "webviz/signals.js";
import { every } from "webviz/timing.js";
import { bookmarks as bookmarkMenu } from "webviz/features/playback/bookmarks.js";
import { timeCommands } from "webviz/features/playback/commands.js";
import { byTime } from "webviz/features/playback/events.js";
import { atMoment, behindAt, isNow, isRewound } from "webviz/moment.js";
import { shownLength } from "webviz/features/playback/range.js";
import { seeks } from "webviz/features/playback/rewound.js";
import { stepMessage } from "webviz/features/playback/step.js";
import { topics as topicList } from "webviz/features/playback/topics.js";
import { track as makeTrack } from "webviz/features/playback/track.js";
import { transport as makeTransport } from "webviz/features/playback/transport.js";
import { parseTime } from "webviz/features/playback/typed_time.js";

/** @import {Moment} from "webviz/types.js" */
/** @import {Timeline, TimelinePlaces} from "webviz/shell/time_bar.js" */
/** @import {Marks} from "webviz/features/playback/gestures.js" */
/** @import {Seeks} from "webviz/features/playback/rewound.js" */

const TICK_MS = 200;
/** @type {Marks} */
const NO_MARKS = { counts: [], counted: [0, 1], bookmarks: [], events: [] };

const playback = store("playback");
const clock = store("clock");
const density = store("density");
const bookmarks = store("bookmarks");
const events = store("events");

const isThere = () => playback.has("start");
const isBag = () => isThere() && playback.get("is_live") === null;
const names = () => playback.get("names") ?? [];

/**
 * Puts a track and buttons into elements while there is a past; `toggle` plays or pauses.
 *
 * @param {TimelinePlaces} places
 * @returns {Timeline}
 */
export function timeline(places) {
  const recording = recordingNow();
  const marks = computed(marksNow);
  const position = () => seek.target() ?? recording.value.get("position");
  /** @param {number} time */
  const isLiveAt = (time) =>
    recording.value.size > 0 && isNow(recording.value, time, track.length());
  const seek = seeks(isLiveAt);
  const topic = signal(""); // of which the next message is shown, "" for all that are displayed
  const track = makeTrack(seek, recording, marks);
  const topics = topicList({ range: track.range, counted: () => marks.value.counted, topic });
  const menu = bookmarkMenu(seek, position, () => !isBag() && !isRewound(playback));
  const buttons = makeTransport({ seek, recording, position, topic, topics, bookmarks: menu });

  // Another recording has other topics and marks.
  const subject = computed(() => (isThere() ? names().join() : null));
  effect(() => {
    const shows = subject.value !== null;
    document.body.classList.toggle("wv-recording", shows);
    if (!shows) return;
    places.track.replaceChildren(topics.element, track.element);
    places.buttons.replaceChildren(buttons);
    owned(() => {
      places.track.replaceChildren();
      places.buttons.replaceChildren();
    });
    untracked(() => isBag() && seekLinked(seek, recording.value));
  });

  const { ofRecordings, ofBags, ofLive, ofAll } = timeCommands({
    recording: () => recording.value,
    seek,
    position,
    events: () => marks.value.events,
    play: places.toggle,
    step: (isForward) => stepMessage(topic.value, isForward),
    addBookmark: menu.add,
    copyLink: () => copyLink(position()),
    showTopics: topics.toggle,
  });
  provide(() => {
    if (!isThere()) return [];
    if (isBag()) return [...ofRecordings, ...ofBags, ...ofAll];
    return [...(isRewound(playback) ? ofRecordings : ofLive), ...ofAll];
  });

  return {
    isThere: () => isBag() || (isThere() && isRewound(playback)),
    isPast: () => isThere() && (!isBag() || playback.get("is_memory") === true),
    names: () => (isBag() ? names().join(", ") : null),
  };
}

/** The recording at this moment, which goes on with time unless it is a bag; empty without one. */
function recordingNow() {
  const ticks = signal(0);
  effect(() => {
    if (isThere() && !isBag()) every(TICK_MS, () => document.hidden || (ticks.value += 1));
  });
  return computed(() => {
    if (!isThere()) return /** @type {Moment} */ (new Map());
    const behind = ticks.value >= 0 ? behindAt(clock, wallNow()) : 0;
    return atMoment(playback.all(), wallNow(), behind);
  });
}

/** @returns {Marks} */
function marksNow() {
  if (!isThere()) return NO_MARKS;
  const [first, last] = [density.get("first") ?? 0, density.get("last") ?? 0];
  return {
    counts: density.get("counts") ?? [],
    counted: [first, first + shownLength(last - first)],
    bookmarks: bookmarks.get("all") ?? [],
    events: byTime(events.all()),
  };
}

/**
 * Seeks the moment that a link names: once, since people go on from there.
 *
 * @param {Seeks} seek
 * @param {Moment} recording
 */
function seekLinked(seek, recording) {
  const address = new URL(location.href);
  const text = address.searchParams.get("t");
  if (text === null) return;
  address.searchParams.delete("t");
  history.replaceState(history.state, "", address);
  const time = parseTime(text, recording.get("start"));
  if (time === null) toast(`The link has an invalid time: t=${text}.`, { level: "warn" });
  else seek.to(time);
}

/** @param {number} position */
async function copyLink(position) {
  const address = new URL(location.pathname, location.href);
  address.searchParams.set("t", position.toFixed(3));
  const isCopied = await copy(address.href);
  toast(isCopied ? "Copied the link to this moment." : `The link to this moment: ${address.href}`);
}
