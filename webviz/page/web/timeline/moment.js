// The recording, or the past of live topics, at this moment.

/**
 * The store "playback", a Map, with "first", "duration", "position" and "ago" in seconds; those of live
 * topics go on with time.
 *
 * @param {Map<string, any>} values
 * @param {number} wall time in seconds
 */
export function atMoment(values, wall) {
  const isLive = values.get("is_live");
  if (isLive === null) return new Map([["first", 0], ["ago", 0], ...values]);
  const duration = wall - values.get("start") - values.get("ahead");
  const position = isLive ? duration : values.get("position");
  const first = isLive ? duration - values.get("held") : values.get("first");
  return new Map([...values, ["first", first], ["duration", duration], ["position", position], ["ago", duration - position]]);
}

/** True if the past of live topics is shown. */
export const isRewound = (recording) => recording?.get("is_live") === false;

/** True if a time is as good as now, for live topics on a track of this length. */
export const isNow = (recording, time, length) =>
  recording.get("is_live") !== null && time >= recording.get("duration") - length / 200;

/** Seconds ago in words. */
export const agoText = (seconds) => `${seconds < 100 ? seconds.toFixed(1) : seconds.toFixed(0)} s ago`;

/** Seconds before now, which is 0, for a scale. */
export const beforeText = (seconds, digits = 1) => (seconds > -0.05 ? "now" : `−${(-seconds).toFixed(digits)} s`);
