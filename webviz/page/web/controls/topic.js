// A topic: one of those that carry the right type, or any name.

import { set } from "../dom.js";
import { watch } from "../stores.js";
import { combobox } from "./combobox.js";

/** @import {ValuesOf} from "../types.js" */

/** A field for the name of a topic; see `control.js`. `live(known)` shows the rate it arrives at. */
export function topic({ type, default: standard }, { label, change, refused }) {
  let value = standard ?? "";
  let rate = null;
  /** @type {ValuesOf<"topics_of">} */
  let topics = new Map();

  const options = () => {
    const all = [...topics].map(([name, known]) => ({ value: name, ...describe(known) }));
    all.sort((a, b) => (a.value < b.value ? -1 : 1));
    // While the list is shut the field has the note of its own topic.
    if (!topics.has(value) && rate !== null) all.push({ value, note: hertz(rate) });
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
    update(next) {
      value = next;
      field.update({ value, options: options() });
    },
    live(known) {
      rate = known.rate;
      if (!topics.size) field.update({ options: options() });
    },
  };
}

function describe({ publishers, rate, shown, problem }) {
  if (problem) return { note: problem, level: "error" };
  const notes = [publishers === 1 ? "1 publisher" : `${publishers} publishers`];
  if (rate !== null) notes.unshift(hertz(rate));
  if (shown.length)
    notes.push(`shown by ${shown[0]}${shown.length > 1 ? ` and ${shown.length - 1} more` : ""}`);
  return { note: notes.join(" · ") };
}

const hertz = (rate) => `${rate} Hz`;
