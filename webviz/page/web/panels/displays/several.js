// The properties that several displays have in common, edited together.

import { act, newStep } from "webviz/act.js";
import { declaredForm, form } from "webviz/controls/form.js";
import { el } from "webviz/dom.js";
import { sanitized } from "webviz/sanitize.js";
import { computed } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { commonOf, filled, valuesOf } from "webviz/panels/displays/common.js";

/** @import {Stores} from "webviz/contents.js" */
/** @import {FormValues, StoreReader} from "webviz/types.js" */

const MAX_DISPLAYS = 50;
const SAME_MS = 1500; // changes of one property that follow each other are undone together

/**
 * The common properties of displays.
 *
 * @param {string[]} ids
 */
export function severalProperties(ids) {
  if (ids.length > MAX_DISPLAYS)
    return [note(() => `Select at most ${MAX_DISPLAYS} displays to edit them together.`)];
  const stores = ids.map((id) => store(`properties:${id}`));
  const declared = computed(() => {
    const lists = stores.flatMap((values) => {
      const own = values.get("declared");
      return own ? [own] : [];
    });
    return lists.length < ids.length ? null : commonOf(lists);
  });
  const merged = computed(() => valuesOf(stores, declared.value ?? []));
  /** @type {FormValues} */
  const values = {
    get: (key) => (key === "declared" ? declared.value : merged.value.get(key)),
  };
  const options = { values, send: sender(ids, stores), name: "several", command: "SetProperty" };
  return [
    note(() => (declared.value?.length === 0 ? "These displays have no property in common." : "")),
    el(
      "div",
      {},
      declaredForm(values, (common) => form(common, options)),
    ),
  ];
}

/** @param {() => string} text */
const note = (text) => el("p", { class: "wv-details-note wv-quiet", hidden: () => !text() }, text);

/**
 * Sends a property of several displays, as one step to undo.
 *
 * @param {string[]} ids
 * @param {StoreReader<Stores["properties"]>[]} stores
 */
function sender(ids, stores) {
  let last = { path: "", at: 0, step: 0 };
  return async (/** @type {string} */ path, /** @type {unknown} */ value) => {
    const now = performance.now();
    const goesOn = last.path === path && now - last.at < SAME_MS;
    const step = goesOn ? last.step : newStep();
    last = { path, at: now, step };
    const answers = await Promise.all(
      ids.map(async (display, index) => {
        const own = stores[index].get(`value.${path}`);
        const fields = { display, path, value: filled(value, own) };
        const answer = await act("SetProperty", fields, { quiet: true, errors: "caller", step });
        const name = sanitized(stores[index].get("name") ?? "");
        return answer.level === "error" ? { ...answer, text: `${name}: ${answer.text}` } : answer;
      }),
    );
    return answers.find(({ level }) => level === "error") ?? answers[0];
  };
}
