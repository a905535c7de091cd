// The timeline of a recording: a track over the bar of the time, and buttons within it.

import { act } from "../act.js";
import { isTyping, provide } from "../shell/commands.js";
import { watch } from "../stores.js";
import { seeks } from "./seeks.js";
import { topics as topicList } from "./topics.js";
import { track as makeTrack } from "./track.js";
import { transport as makeTransport } from "./transport.js";

const JUMP_S = 5;

/**
 * Puts a track and buttons into elements while a recording is played. Returns `isThere()`.
 *
 * @param {{ track: Element, buttons: Element }} places
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
    range: track.range, whole: () => recording.get("duration"), step, toggled: () => show(),
  });
  const buttons = makeTransport(seek, step, topics);
  let endCounts = null;

  function show() {
    if (!recording) return;
    track.show(recording);
    buttons.show(recording, position());
    document.body.classList.toggle("wv-recorded-open", topics.isOpen());
  }

  function appear(isThere) {
    document.body.classList.toggle("wv-recording", isThere);
    places.track.replaceChildren(...(isThere ? [topics.element, track.element] : []));
    places.buttons.replaceChildren(...(isThere ? [buttons.element] : []));
    endCounts?.();
    endCounts = isThere ? watch("density", (density) => track.setCounts(density.get("counts") ?? [])) : null;
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
  const toggle = () => act("Pause", { paused: recording.get("is_playing") });
  const jump = (seconds) => seek.to(Math.max(0, Math.min(position() + seconds, recording.get("duration"))));
  const commands = [
    { name: "Play or pause the recording", icon: "play", key: " ", needs: "Pause", run: toggle },
    { name: "Next message", icon: "step", key: "ArrowRight", needs: "StepMessage", run: () => step.run(true) },
    { name: "Previous message", icon: "step-back", key: "ArrowLeft", needs: "StepMessage", run: () => step.run(false) },
    { name: `${JUMP_S} s on`, key: "Shift+ArrowRight", needs: "Seek", run: () => jump(JUMP_S) },
    { name: `${JUMP_S} s back`, key: "Shift+ArrowLeft", needs: "Seek", run: () => jump(-JUMP_S) },
    { name: "Start of the recording", key: "Home", needs: "Seek", run: () => seek.to(0) },
    { name: "End of the recording", key: "End", needs: "Seek", run: () => seek.to(recording.get("duration")) },
    { name: "Topics of the recording", icon: "list", run: topics.toggle },
  ].map((one) => ({ ...one, group: "Time", isKeyHere: isFree }));
  provide(() => (recording ? commands : []));

  return { isThere: () => recording !== null };
}
