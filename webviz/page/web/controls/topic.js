// A topic: one of those that carry the right type, or any name.

import { store } from "webviz/stores.js";
import { hertz, isHiddenTopic } from "webviz/words.js";
import { combobox } from "webviz/controls/combobox.js";

/** @import {Choice, Control, ControlOptions} from "webviz/types.js" */
/** @import {Mixed} from "webviz/controls/mixed.js" */
/** @import {DeclaredProperty, LiveTopic, TopicOffer} from "webviz/contents.js" */

/**
 * A field for the name of a topic; see `control.js`. What is `known` has the rate it arrives at.
 *
 * @param {DeclaredProperty} property
 * @param {ControlOptions<string | Mixed>} options
 * @returns {Control}
 */
export function topic({ type, default: standard }, options) {
  const topics = store(`topics_of:${type}`);
  const value = () => options.value() ?? String(standard ?? "");
  return combobox({
    ...options,
    value,
    options(isOpen) {
      /** @type {Choice[]} */
      const all = isOpen
        ? [...topics.all()].map(([name, offer]) => ({ value: name, ...describe(offer) }))
        : [];
      const rank = ({ value = "" }) => `${isHiddenTopic(value) ? 1 : 0}${value}`;
      all.sort((a, b) => (rank(a) < rank(b) ? -1 : 1));
      // While the list is shut the field has the note of its own topic.
      const own = value();
      const current = /** @type {LiveTopic | undefined} */ (options.live?.());
      if (
        typeof own === "string" &&
        current &&
        current.rate !== null &&
        !all.some((one) => one.value === own)
      )
        all.push({ value: own, note: hertz(current.rate, current.is_latched) });
      return all;
    },
    placeholder: "No topic",
  });
}

/** @param {TopicOffer} offer */
function describe({ publishers, rate, displays, problem, is_latched }) {
  if (problem) return { note: problem, level: "error" };
  const notes = [publishers === 1 ? "1 publisher" : `${publishers} publishers`];
  if (rate !== null) notes.unshift(hertz(rate, is_latched));
  if (displays.length)
    notes.push(
      `shown by ${displays[0]}${displays.length > 1 ? ` and ${displays.length - 1} more` : ""}`,
    );
  return { note: notes.join(" · ") };
}
