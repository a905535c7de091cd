// Commands of this page to the viewer, and their answers.

import { why } from "./access.js";
import * as channel from "./channel.js";
import { toast } from "./shell/toasts.js";

const waiting = new Map();
let count = 0;

channel.on("Done", ({ number, level, text, display }) => {
  const done = waiting.get(number);
  waiting.delete(number);
  done?.({ level, text, display });
});
// Commands under way when the connection was lost are not answered any more.
channel.onOpen(() => waiting.clear());

/**
 * Sends a command of `webviz.commands` with its fields. Resolves with `{level, text, display}`: "ok"
 * or "error", a sentence or "", and the id of the display that it made. What there is to say is shown
 * as a toast, unless `quiet`; errors always are, unless the "caller" shows them itself. Commands with
 * the same `step`, a number of `newStep`, are undone together.
 */
export function act(command, fields = {}, { quiet = false, errors = "toast", step = 0 } = {}) {
  const refusal = why(command);
  const answer = refusal
    ? Promise.resolve({ level: "error", text: refusal, display: "" })
    : request({ type: "Do", command, arguments: fields, step });
  answer.then(({ level, text }) => {
    const isShown = level === "error" ? errors === "toast" : !quiet;
    if (text && isShown) toast(text, { level });
  });
  return answer;
}

/** A number for commands that are undone together. */
export const newStep = () => (count += 1);

/** Reports the use of a widget in a plug-in's panel; otherwise like `act`. */
export function use(panel, widget, value = null) {
  const refusal = why("Use");
  const answer = refusal
    ? Promise.resolve({ level: "error", text: refusal })
    : request({ type: "Use", panel, widget, value });
  answer.then(({ level, text }) => {
    if (text) toast(text, { level });
  });
  return answer;
}

/** Ends the visit of a browser, and if it `revokes`, its link; otherwise like `act`. */
export function dismiss(browser, revokes) {
  const answer = request({ type: "Dismiss", browser, revokes });
  answer.then(({ level, text }) => {
    if (text) toast(text, { level });
  });
  return answer;
}

/** Ends a link and all visits by it; otherwise like `act`. */
export function revoke(name) {
  const answer = request({ type: "Revoke", name });
  answer.then(({ level, text }) => {
    if (text) toast(text, { level });
  });
  return answer;
}

function request(message) {
  count += 1;
  channel.send({ ...message, number: count });
  return new Promise((resolve) => waiting.set(count, resolve));
}
