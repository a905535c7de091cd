// Statuses and properties of a display, and what holds for the viewer as a whole.

import { act } from "../../act.js";
import { form } from "../../controls/form.js";
import { el } from "../../dom.js";
import { watch } from "../../stores.js";
import { statuses } from "./statuses.js";

/** @import {DeclaredProperty, RemedyButton, StatusLine, WorstStatus} from "../../contents.js" */
/** @import {FormValues, Outcome, Vec3} from "../../types.js" */

/** @typedef {ReturnType<typeof form>} Form */

const LEVELS = ["ok", "warn", "error"];
const QUIET = /** @type {const} */ ({ quiet: true, errors: "caller" });
/** @type {Record<string, (value: unknown) => Promise<Outcome>>} */
const SETTINGS = {
  fixed_frame: (frame) => act("SetFixedFrame", { frame: String(frame) }, QUIET),
  background: (color) => act("SetBackground", { color: /** @type {Vec3 | null} */ (color) }, QUIET),
  frame_rate: (hz) => act("SetFrameRate", { hz: Number(hz) }, QUIET),
};

/**
 * Fills an element with the statuses and properties of a display; returns what ends it.
 *
 * @param {HTMLElement} element
 * @param {string} id
 */
export function properties(element, id) {
  /**
   * @param {string} path
   * @param {unknown} value
   */
  const send = (path, value) => act("SetProperty", { display: id, path, value }, QUIET);
  const said = statuses({
    display: id,
    open: (show) =>
      watch(`statuses:${id}`, (values) =>
        show(values.get("statuses") ?? [], values.get("more") ?? 0),
      ),
  });
  const place = el("div");
  element.append(said.element, place);
  const made = maker(place, (declared, values) =>
    form(declared, { send, name: String(values.get("type")), command: "SetProperty" }),
  );
  const end = watch(`properties:${id}`, (values, changed) => {
    if (changed.has("worst")) said.worst(values.get("worst"));
    made.update(values, changed);
  });
  return () => {
    end();
    made.end();
    said.end();
    element.replaceChildren();
  };
}

/**
 * Fills an element with what holds for the whole viewer; returns what ends it.
 *
 * @param {HTMLElement} element
 */
export function globalOptions(element) {
  /**
   * @param {string} path
   * @param {unknown} value
   */
  const send = (path, value) => SETTINGS[path](value);
  /** @type {((lines: StatusLine[], more: number) => void) | null} */
  let show = null;
  /** @type {[StatusLine[], number]} */
  let lines = [[], 0];
  const said = statuses({
    display: "",
    /** @param {(lines: StatusLine[], more: number) => void} listener */
    open(listener) {
      show = listener;
      show(...lines);
      return () => {
        show = null;
      };
    },
  });
  const place = el("div");
  element.append(said.element, place);
  const made = maker(place, (declared) =>
    form(declared.map(withFrame), {
      send,
      name: "settings",
      command: "SetFixedFrame",
    }),
  );
  const end = watch("settings", (values, changed) => {
    if (changed.has("statuses")) {
      lines = [values.get("statuses"), values.get("more")];
      said.worst(worst(lines[0]));
      show?.(...lines);
    }
    made.update(values, changed);
  });
  return () => {
    end();
    made.end();
    said.end();
    element.replaceChildren();
  };
}

/**
 * Makes the form anew when something else is declared, and keeps it up to date; `end()` ends it.
 *
 * @param {HTMLElement} place
 * @param {(declared: DeclaredProperty[], values: FormValues) => Form} make
 */
export function maker(place, make) {
  /** @type {Form | null} */
  let shown = null;
  let declared = "";
  /**
   * @param {FormValues & {keys(): Iterable<string>}} values
   * @param {Set<string>} changed
   */
  function update(values, changed) {
    const now = JSON.stringify(values.get("declared") ?? []);
    const isNew = now !== declared;
    if (isNew) {
      declared = now;
      shown?.end();
      shown = make(JSON.parse(now), values);
      place.replaceChildren(shown.element);
    }
    shown?.update(values, isNew ? new Set(values.keys()) : changed);
  }
  return { update, end: () => shown?.end() };
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
