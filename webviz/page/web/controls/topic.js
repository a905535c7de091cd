// A topic: one of those that carry the right type, or any name.

import { set } from "../dom.js";
import { watch } from "../stores.js";
import { combobox } from "./combobox.js";

/** @import {Choice, Control, ControlOptions, ValuesOf} from "../types.js" */
/** @import {Mixed} from "./mixed.js" */
/** @import {DeclaredProperty, LiveTopic, TopicOffer} from "../contents.js" */

/**
 * A field for the name of a topic; see `control.js`. `live(known)` shows the rate it arrives at.
 *
 * @param {DeclaredProperty} property
 * @param {ControlOptions} options
 * @returns {Control}
 */
export function topic({ type, default: standard }, { label, change, refused }) {
  /** @type {string | Mixed} */
  let value = String(standard ?? "");
  /** @type {number | null} */
  let rate = null;
  /** @type {ValuesOf<"topics_of">} */
  let topics = new Map();

  const options = () => {
    /** @type {Choice[]} */
    const all = [...topics].map(([name, known]) => ({ value: name, ...describe(known) }));
    all.sort((a, b) => (a.value < b.value ? -1 : 1));
    // While the list is shut the field has the note of its own topic.
    const own = typeof value === "string" && !topics.has(value) ? value : null;
    if (own !== null && rate !== null) all.push({ value: own, note: hertz(rate) });
    return all;
  };
  const field = combobox({
    label,
    value,
    options: [],
    change,
    refused,
    placeholder: "No topic",
    opened: () => {
      const end = watch(`topics_of:${type}`, (values) => {
        topics = values;
        field.update({ options: options() });
      });
      return () => {
        end();
        topics = new Map();
        field.update({ options: options() });
      };
    },
  });
  return {
    element: field.element,
    focus: () => field.input.focus(),
    describe: (text) => set(field.input, { "aria-description": text }),
    /** @param {string | Mixed} next */
    update(next) {
      value = next;
      field.update({ value, options: options() });
    },
    /** @param {LiveTopic} known */
    live(known) {
      rate = known.rate;
      if (!topics.size) field.update({ options: options() });
    },
  };
}

/** @param {TopicOffer} offer */
function describe({ publishers, rate, shown, problem }) {
  if (problem) return { note: problem, level: "error" };
  const notes = [publishers === 1 ? "1 publisher" : `${publishers} publishers`];
  if (rate !== null) notes.unshift(hertz(rate));
  if (shown.length)
    notes.push(`shown by ${shown[0]}${shown.length > 1 ? ` and ${shown.length - 1} more` : ""}`);
  return { note: notes.join(" · ") };
}

/** @param {number} rate */
const hertz = (rate) => `${rate} Hz`;
