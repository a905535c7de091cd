// Statuses and properties of a display, and what holds for the viewer as a whole.

import { act } from "webviz/act.js";
import { declaredForm, form } from "webviz/controls/form.js";
import { el } from "webviz/dom.js";
import { store } from "webviz/stores.js";
import { statuses } from "webviz/panels/displays/statuses.js";

/** @import {DeclaredProperty, StatusLine, WorstStatus} from "webviz/contents.js" */
/** @import {Outcome, SendProperty, Vec3} from "webviz/types.js" */

const LEVELS = ["ok", "warn", "error"];
const QUIET = /** @type {const} */ ({ quiet: true, errors: "caller" });
/** @type {Record<string, (value: unknown) => Promise<Outcome>>} */
const SETTINGS = {
  fixed_frame: (frame) => act("SetFixedFrame", { frame: String(frame) }, QUIET),
  background: (color) => act("SetBackground", { color: /** @type {Vec3 | null} */ (color) }, QUIET),
  frame_rate: (hz) => act("SetFrameRate", { hz: Number(hz) }, QUIET),
};

/**
 * The statuses and properties of a display.
 *
 * @param {string} id
 */
export function propertiesOf(id) {
  const values = store(`properties:${id}`);
  const lines = store(`statuses:${id}`);
  /** @type {SendProperty} */
  const send = (path, value) => act("SetProperty", { display: id, path, value }, QUIET);
  const options = { values, send, command: "SetProperty" };
  return [
    statuses({
      display: id,
      worst: () => values.get("worst"),
      lines: () => lines.get("statuses") ?? [],
      more: () => lines.get("more") ?? 0,
    }),
    el(
      "div",
      {},
      declaredForm(values, (declared) =>
        form(declared, { ...options, name: String(values.get("type")) }),
      ),
    ),
  ];
}

/** The statuses and settings of the whole viewer. */
export function globalOptions() {
  const values = store("settings");
  const lines = () => values.get("statuses") ?? [];
  /** @type {SendProperty} */
  const send = (path, value) => SETTINGS[path](value);
  const options = { values, send, name: "settings", command: "SetFixedFrame" };
  return [
    statuses({
      display: "",
      worst: () => worst(lines()),
      lines,
      more: () => values.get("more") ?? 0,
    }),
    el(
      "div",
      {},
      declaredForm(values, (declared) => form(declared.map(withFrame), options)),
    ),
  ];
}

/**
 * @param {DeclaredProperty} property
 * @returns {DeclaredProperty & {isFixed?: boolean}}
 */
const withFrame = (property) =>
  property.path === "fixed_frame" ? { ...property, kind: "frame", isFixed: true } : property;

/**
 * @param {StatusLine[]} lines
 * @returns {WorstStatus | null}
 */
function worst(lines) {
  const [line] = [...lines].sort((a, b) => LEVELS.indexOf(b[1]) - LEVELS.indexOf(a[1]));
  return line ? { key: line[0], level: line[1], text: line[2] } : null;
}
