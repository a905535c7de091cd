// The recording, or the past of live topics, at this moment.

/** @import {Moment, ValuesOf} from "webviz/types.js" */

/**
 * The store "playback", a Map, with "first", "duration", "position" and "ago" in seconds; those of live
 * topics go on with time.
 *
 * @param {ValuesOf<"playback">} values
 * @param {number} wall time in seconds
 * @param {number} [behind] how far a live scene that is paused is behind now, in seconds
 * @returns {Moment}
 */
export function atMoment(values, wall, behind = 0) {
  const isLive = values.get("is_live");
  /** @type {Moment} */
  const moment = new Map(values);
  if (isLive === null) return new Map([["first", 0], ["ago", 0], ...moment]);
  const duration = wall - moment.get("start") - moment.get("ahead");
  const first = isLive ? duration - moment.get("memory_s") : moment.get("first");
  const position = isLive ? Math.max(first, duration - behind) : moment.get("position");
  return new Map([
    ...moment,
    ["first", first],
    ["duration", duration],
    ["position", position],
    ["ago", duration - position],
  ]);
}

/**
 * Seconds since the scene was paused, 0 while it is not.
 *
 * @param {{get(key: "is_paused"): boolean | undefined, get(key: "pace"): number[] | undefined}} clock
 * @param {number} wall time in seconds
 */
export function behindAt(clock, wall) {
  const [, since = wall] = (clock.get("is_paused") && clock.get("pace")) || [];
  return Math.max(0, wall - since);
}

/**
 * True if the past of live topics is shown.
 *
 * @param {{get(key: "is_live"): boolean | null | undefined} | null} recording
 */
export const isRewound = (recording) => recording?.get("is_live") === false;

/**
 * True if a recording is shown in the place of live topics.
 *
 * @param {{get(key: "is_opened"): boolean | undefined} | null} recording
 */
export const isOpened = (recording) => recording?.get("is_opened") === true;

/**
 * True if a time is as good as now, for live topics on a track of this length.
 *
 * @param {Moment} recording
 * @param {number} time
 * @param {number} length
 */
export const isNow = (recording, time, length) =>
  recording.get("is_live") !== null && time >= recording.get("duration") - length / 200;

/**
 * Seconds ago in words.
 *
 * @param {number} seconds
 */
export const agoText = (seconds) =>
  `${seconds < 100 ? seconds.toFixed(1) : seconds.toFixed(0)} s ago`;

/**
 * Seconds before now, which is 0, for a scale.
 *
 * @param {number} seconds
 * @param {number} [digits]
 */
export const beforeText = (seconds, digits = 1) =>
  seconds > -0.05 ? "now" : `−${(-seconds).toFixed(digits)} s`;
