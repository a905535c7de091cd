// Statuses and properties of a display, and what holds for the viewer as a whole.

import { act } from "../../act.js";
import { form } from "../../controls/form.js";
import { el } from "../../dom.js";
import { watch } from "../../stores.js";
import { statuses } from "./statuses.js";

/** @import {DeclaredProperty} from "../../contents.js" */
/** @import {FormValues} from "../../types.js" */

/** @typedef {ReturnType<typeof form>} Form */

const LEVELS = ["ok", "warn", "error"];
const SETTINGS = {
  fixed_frame: (frame) => ["SetFixedFrame", { frame }],
  background: (color) => ["SetBackground", { color }],
  frame_rate: (hz) => ["SetFrameRate", { hz }],
};

/** Fills an element with the statuses and properties of a display; returns what ends it. */
export function properties(element, id) {
  const send = (path, value) =>
    act("SetProperty", { display: id, path, value }, { quiet: true, errors: "caller" });
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

/** Fills an element with what holds for the whole viewer; returns what ends it. */
export function globalOptions(element) {
  const send = (path, value) => {
    const [command, fields] = SETTINGS[path](value);
    return act(command, fields, { quiet: true, errors: "caller" });
  };
  let show = null;
  let lines = [[], 0];
  const said = statuses({
    display: "",
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

const withFrame = (property) =>
  property.path === "fixed_frame" ? { ...property, kind: "frame", isFixed: true } : property;

function worst(lines) {
  const [line] = [...lines].sort((a, b) => LEVELS.indexOf(b[1]) - LEVELS.indexOf(a[1]));
  return line ? { key: line[0], level: line[1], text: line[2] } : null;
}
