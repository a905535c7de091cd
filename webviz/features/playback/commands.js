// The commands of the timeline, which have keys while nothing else wants them.

import { isTyping } from "webviz/commands.js";
import { eventCommand } from "webviz/features/playback/events.js";

/** @import {LoggedEvent, Moment} from "webviz/types.js" */
/** @import {Seeks} from "webviz/features/playback/rewound.js" */

const JUMP_S = 5;

function isFree() {
  const focused = document.activeElement;
  return (
    !isTyping({ target: focused }) &&
    !focused?.closest("button, [role=option], [role=treeitem], .wv-rows")
  );
}

/**
 * Returns `{ofRecordings, ofBags, ofLive, ofAll}`: commands of a recording or a past that is shown, of bags
 * only, of live topics while they arrive, and of all of these.
 *
 * @param {{
 *   recording: () => Moment, seek: Seeks, position: () => number, events: () => LoggedEvent[],
 *   play: () => unknown, step: (isForward: boolean) => unknown, addBookmark: () => unknown,
 *   copyLink: () => unknown, showTopics: () => unknown,
 * }} timeline
 */
export function timeCommands(timeline) {
  const { recording, seek, position, events, step } = timeline;
  /** @param {number} seconds */
  const jump = (seconds) =>
    seek.to(
      Math.max(
        recording().get("first"),
        Math.min(position() + seconds, recording().get("duration")),
      ),
    );
  const among = { all: events, seek, position };
  const back = {
    name: `${JUMP_S} s back`,
    key: "Shift+ArrowLeft",
    needs: "Seek",
    run: () => jump(-JUMP_S),
    repeats: true,
  };
  const previous = eventCommand(false, among);
  const ofRecordings = [
    {
      name: "Play or pause the recording",
      icon: "play",
      key: " ",
      needs: "Pause",
      run: timeline.play,
    },
    {
      name: "Next message",
      icon: "step",
      key: "ArrowRight",
      needs: "StepMessage",
      run: () => step(true),
      repeats: true,
    },
    {
      name: "Previous message",
      icon: "step-back",
      key: "ArrowLeft",
      needs: "StepMessage",
      run: () => step(false),
      repeats: true,
    },
    {
      name: `${JUMP_S} s on`,
      key: "Shift+ArrowRight",
      needs: "Seek",
      run: () => jump(JUMP_S),
      repeats: true,
    },
    back,
    {
      name: "Start of the recording",
      key: "Home",
      needs: "Seek",
      run: () => seek.to(recording().get("first")),
    },
    {
      name: "End of the recording",
      key: "End",
      needs: "Seek",
      run: () => seek.to(recording().get("duration")),
    },
    eventCommand(true, among),
    previous,
    {
      name: "Add bookmark…",
      icon: "flag",
      key: "b",
      needs: "SaveBookmark",
      run: timeline.addBookmark,
    },
  ];
  /**
   * @template T
   * @param {T} one
   */
  const about = (one) => ({ ...one, group: "Time", isKeyHere: isFree });
  return {
    ofRecordings: ofRecordings.map(about),
    ofBags: [{ name: "Copy link to this moment", icon: "copy", run: timeline.copyLink }].map(about),
    ofLive: [back, previous].map(about),
    ofAll: [{ name: "Topics of the timeline", icon: "list", run: timeline.showTopics }].map(about),
  };
}
