// The properties that several displays have in common, edited together.

import { act, newStep } from "../../act.js";
import { form } from "../../controls/form.js";
import { el } from "../../dom.js";
import { sanitized } from "../../sanitize.js";
import { watch } from "../../stores.js";
import { commonOf, filled, valuesOf } from "./common.js";
import { maker } from "./properties.js";

/** @import {ValuesOf} from "../../types.js" */

const MAX_DISPLAYS = 50;
const SAME_MS = 1500; // changes of one property that follow each other are undone together

/**
 * Fills an element with the common properties of displays; returns what ends it.
 *
 * @param {HTMLElement} element
 * @param {string[]} ids
 */
export function severalProperties(element, ids) {
  const note = el("p", { class: "wv-details-note wv-quiet", hidden: true });
  const place = el("div");
  element.append(note, place);
  /** @param {string} text */
  const tell = (text) => {
    note.textContent = text;
    note.hidden = text === "";
  };
  if (ids.length > MAX_DISPLAYS) {
    tell(`Select at most ${MAX_DISPLAYS} displays to edit them together.`);
    return () => element.replaceChildren();
  }

  /** @type {Map<string, ValuesOf<"properties">>} */
  const stores = new Map();
  /** @type {Map<string, unknown>} */
  let shown = new Map();
  let last = { path: "", at: 0, step: 0 };

  /**
   * @param {string} path
   * @param {unknown} value
   */
  async function send(path, value) {
    const now = performance.now();
    const goesOn = last.path === path && now - last.at < SAME_MS;
    last = { path, at: now, step: goesOn ? last.step : newStep() };
    const answers = await Promise.all(
      ids.map(async (id) => {
        const own = stores.get(id)?.get(`value.${path}`);
        const fields = { display: id, path, value: filled(value, own) };
        const answer = await act("SetProperty", fields, {
          quiet: true,
          errors: "caller",
          step: last.step,
        });
        return { ...answer, id };
      }),
    );
    const failed = answers.find(({ level }) => level === "error");
    return failed
      ? {
          ...failed,
          text: `${sanitized(stores.get(failed.id)?.get("name") ?? "")}: ${failed.text}`,
        }
      : answers[0];
  }

  const made = maker(place, (declared) =>
    form(declared, { send, name: "several", command: "SetProperty" }),
  );
  function update() {
    const all = ids.flatMap((id) => stores.get(id) ?? []);
    const lists = all.flatMap((values) => {
      const declared = values.get("declared");
      return declared ? [declared] : [];
    });
    if (lists.length < ids.length) return;
    const declared = commonOf(lists);
    tell(declared.length ? "" : "These displays have no property in common.");
    /** @type {Map<string, unknown>} */
    const values = valuesOf(all, declared).set("declared", declared);
    const changed = new Set([...values.keys()].filter((key) => values.get(key) !== shown.get(key)));
    shown = values;
    made.update(values, changed);
  }

  const ends = ids.map((id) =>
    watch(`properties:${id}`, (values) => {
      stores.set(id, values);
      update();
    }),
  );
  return () => {
    for (const end of ends) end();
    made.end();
    element.replaceChildren();
  };
}
