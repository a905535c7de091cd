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
 * What commands are about, and what they do.
 *
 * @typedef {{
 *   recording: () => Moment, seek: Seeks, position: () => number, events: () => LoggedEvent[],
 *   play: () => unknown, step: (isForward: boolean) => unknown, addBookmark: () => unknown,
 *   copyLink: () => unknown, showTopics: () => unknown,
 * }} TimelineActions
 */

/**
 * Returns `{ofRecordings, ofBags, ofLive, ofAll}`: commands of a recording or a past that is shown, of bags
 * only, of live topics while they arrive, and of all of these.
 *
 * @param {TimelineActions} timeline
 */
export function timeCommands(timeline) {
  const among = { all: timeline.events, seek: timeline.seek, position: timeline.position };
  const [back, ...others] = seekCommands(timeline);
  const previous = eventCommand(false, among);
  const play = {
    name: "Play or pause the recording",
    icon: "play",
    key: " ",
    needs: "Pause",
    run: timeline.play,
  };
  const mark = {
    name: "Add bookmark…",
    icon: "flag",
    key: "b",
    needs: "SaveBookmark",
    run: timeline.addBookmark,
  };
  const steps = stepCommands(timeline);
  const link = { name: "Copy link to this moment", icon: "copy", run: timeline.copyLink };
  const topics = { name: "Topics of the timeline", icon: "list", run: timeline.showTopics };
  /**
   * @template T
   * @param {T} one
   */
  const about = (one) => ({ ...one, group: "Time", isKeyHere: isFree });
  return {
    ofRecordings: [
      ...[play, ...steps, back, ...others].map(about),
      ...[eventCommand(true, among), previous, mark].map(about),
    ],
    ofBags: [about(link)],
    ofLive: [about(back), about(previous)],
    ofAll: [about(topics)],
  };
}

/** @param {TimelineActions} timeline */
const stepCommands = ({ step }) => [
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
];

/**
 * Jumps, the one back first, and the ends of the recording.
 *
 * @param {TimelineActions} timeline
 */
function seekCommands({ recording, seek, position }) {
  const first = () => recording().get("first");
  const last = () => recording().get("duration");
  /** @param {number} seconds */
  const jump = (seconds) => seek.to(Math.max(first(), Math.min(position() + seconds, last())));
  const needs = "Seek";
  return [
    {
      name: `${JUMP_S} s back`,
      key: "Shift+ArrowLeft",
      needs,
      run: () => jump(-JUMP_S),
      repeats: true,
    },
    {
      name: `${JUMP_S} s on`,
      key: "Shift+ArrowRight",
      needs,
      run: () => jump(JUMP_S),
      repeats: true,
    },
    { name: "Start of the recording", key: "Home", needs, run: () => seek.to(first()) },
    { name: "End of the recording", key: "End", needs, run: () => seek.to(last()) },
  ];
}
