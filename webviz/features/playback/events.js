// Warnings and errors of a recording: `[time, level, text]`, of the log and of displays.

import { toast } from "webviz/toasts.js";

/** @import {LoggedEvent, ValuesOf} from "webviz/types.js" */
/** @import {Seeks} from "webviz/features/playback/rewound.js" */

const CLOSE_S = 0.001; // positions are given in milliseconds
/** @type {Record<string, string>} */
const LEVELS = { warn: "Warning", error: "Error" };

/**
 * All lists of the store "events", a Map, by time.
 *
 * @param {ValuesOf<"events">} events
 * @returns {LoggedEvent[]}
 */
export function byTime(events) {
  const lists = [events.get("logged"), events.get("displays"), events.get("findings")];
  return lists.flatMap((list) => [...(list ?? [])]).sort((a, b) => a[0] - b[0]);
}

/**
 * The text of an event for people, with its level in words.
 *
 * @param {LoggedEvent} event
 */
export const eventText = ([, level, text]) => `${LEVELS[level]} · ${text}`;

/**
 * The command that goes to the next or previous of all events; `seek` is of `seeks.js`.
 *
 * @param {boolean} isNext
 * @param {{all: () => LoggedEvent[], seek: Seeks, position: () => number}} timeline
 */
export function eventCommand(isNext, { all, seek, position }) {
  const which = isNext ? "next" : "previous";
  return {
    name: isNext ? "Next warning" : "Previous warning",
    icon: isNext ? "step" : "step-back",
    needs: "Seek",
    run() {
      const now = position();
      const target = isNext
        ? all().find(([time]) => time > now + CLOSE_S)
        : all().findLast(([time]) => time < now - CLOSE_S);
      if (target) seek.to(target[0]);
      else toast(`There is no ${which} warning or error.`);
    },
  };
}
