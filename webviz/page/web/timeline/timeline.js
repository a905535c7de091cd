// The timeline of a recording: a track over the bar of the time, and buttons within it.

import { act } from "../act.js";
import { copy } from "../clipboard.js";
import { isTyping, provide } from "../shell/commands.js";
import { toast } from "../shell/toasts.js";
import { watch } from "../stores.js";
import { bookmarks as bookmarkMenu } from "./bookmarks.js";
import { byTime, eventCommand } from "./events.js";
import { shownLength } from "./range.js";
import { seeks } from "./seeks.js";
import { topics as topicList } from "./topics.js";
import { track as makeTrack } from "./track.js";
import { transport as makeTransport } from "./transport.js";
import { parseTime } from "./typed_time.js";

const JUMP_S = 5;

/**
 * Puts a track and buttons into elements while a recording is played; `toggle` plays or pauses it.
 * Returns `{isThere(), names()}`.
 *
 * @param {{ track: Element, buttons: Element, toggle: () => unknown }} places
 */
export function timeline(places) {
  let recording = null;
  let topic = ""; // of which the next message is shown, "" for all that are displayed

  const position = () => seek.wanted() ?? recording.get("position");
  const seek = seeks(show);
  const step = {
    topic: () => topic,
    choose(next) {
      topic = next;
      show();
    },
    run: (isForward) => act("StepMessage", { topic, is_forward: isForward }),
  };
  const track = makeTrack(seek, () => topics.redraw());
  const topics = topicList({
    range: track.range, whole: () => shownLength(recording.get("duration")), step, toggled: () => show(),
  });
  const bookmarks = bookmarkMenu(seek, position);
  const buttons = makeTransport(seek, step, topics, bookmarks);
  let events = [];
  let ends = [];

  function show() {
    if (!recording) return;
    track.show(recording);
    buttons.show(recording, position());
  }

  function appear(isThere) {
    document.body.classList.toggle("wv-recording", isThere);
    places.track.replaceChildren(...(isThere ? [topics.element, track.element] : []));
    places.buttons.replaceChildren(...(isThere ? [buttons.element] : []));
    for (const end of ends.splice(0)) end();
    if (!isThere) return;
    ends = [
      watch("density", (density) => track.setCounts(density.get("counts") ?? [])),
      watch("bookmarks", (known) => {
        bookmarks.show(known.get("all") ?? []);
        track.setBookmarks(known.get("all") ?? []);
      }),
      watch("events", (known) => {
        events = byTime(known);
        track.setEvents(events);
      }),
    ];
    begin();
  }

  // A link may name a moment: once, since people go on from there.
  function begin() {
    const address = new URL(location.href);
    const text = address.searchParams.get("t");
    if (text === null) return;
    address.searchParams.delete("t");
    history.replaceState(history.state, "", address);
    const time = parseTime(text, recording.get("start"));
    if (time === null) toast(`The link has no time that can be read: t=${text}.`, { level: "warn" });
    else seek.to(time);
  }

  async function copyLink() {
    const address = new URL(location.pathname, location.href);
    address.searchParams.set("t", position().toFixed(3));
    const isCopied = await copy(address.href);
    toast(isCopied ? "Copied the link to this moment." : `The link to this moment: ${address.href}`);
  }

  watch("playback", (values) => {
    const isThere = values.has("duration");
    const isNew = isThere !== (recording !== null);
    recording = isThere ? values : null;
    if (isNew) appear(isThere);
    show();
  });

  const isFree = () => {
    const focused = document.activeElement;
    return !isTyping({ target: focused }) && !focused?.closest("button, [role=option], [role=treeitem], .wv-rows");
  };
  const jump = (seconds) => seek.to(Math.max(0, Math.min(position() + seconds, recording.get("duration"))));
  const among = { all: () => events, seek, position };
  const commands = [
    { name: "Play or pause the recording", icon: "play", key: " ", needs: "Pause", run: places.toggle },
    { name: "Next message", icon: "step", key: "ArrowRight", needs: "StepMessage", run: () => step.run(true) },
    { name: "Previous message", icon: "step-back", key: "ArrowLeft", needs: "StepMessage", run: () => step.run(false) },
    { name: `${JUMP_S} s on`, key: "Shift+ArrowRight", needs: "Seek", run: () => jump(JUMP_S) },
    { name: `${JUMP_S} s back`, key: "Shift+ArrowLeft", needs: "Seek", run: () => jump(-JUMP_S) },
    { name: "Start of the recording", key: "Home", needs: "Seek", run: () => seek.to(0) },
    { name: "End of the recording", key: "End", needs: "Seek", run: () => seek.to(recording.get("duration")) },
    eventCommand(true, among),
    eventCommand(false, among),
    { name: "Add bookmark…", icon: "flag", key: "b", needs: "SaveBookmark", run: bookmarks.add },
    { name: "Copy link to this moment", icon: "copy", run: copyLink },
    { name: "Topics of the recording", icon: "list", run: topics.toggle },
  ].map((one) => ({ ...one, group: "Time", isKeyHere: isFree }));
  provide(() => (recording ? commands : []));

  return { isThere: () => recording !== null, names: () => recording?.get("names").join(", ") };
}
