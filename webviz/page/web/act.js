// Commands of this page to the viewer, and their answers.

import { why } from "webviz/access.js";
import * as channel from "webviz/channel.js";
import { counter } from "webviz/numbers.js";
import { toast } from "webviz/toasts.js";

/** @import {CommandRequest, CommandResult, Commands} from "webviz/messages.js" */

/** @typedef {{level: string, text: string, [made: string]: string}} Answer */

/** @type {Map<number, (answer: {level: string, text: string}) => void>} */
const waiting = new Map();
/** @type {Map<string, (result: CommandResult) => void>} */
const listeners = new Map();
/** @type {Map<string, (fields: any) => Promise<Answer> | null>} */
const detours = new Map();
const nextNumber = counter();

channel.on("CommandResult", (message) => {
  const { number, level, text, result } = message;
  waiting.get(number)?.({ level, text, ...result });
  waiting.delete(number);
  listeners.get(message.command)?.(message);
});
// Commands under way when the connection was lost are not answered any more.
channel.onOpen(() => {
  for (const answer of waiting.values()) answer({ level: "error", text: "" });
  waiting.clear();
});

/**
 * Sends a command with its fields. Resolves with `{level, text}` and what it made, such as `display`:
 * "ok" or "error", a sentence or "", and the id of a new display. What there is to say is shown as a
 * toast, unless `quiet`; errors always are, unless the "caller" shows them itself. Commands with the
 * same `step`, a number of `newStep`, are undone together. `isDirect` ones take no detour.
 *
 * @template {keyof Commands} C
 * @param {C} command
 * @param {Commands[C]} [fields]
 * @param {{quiet?: boolean, errors?: "toast" | "caller", step?: number, isDirect?: boolean}} [options]
 * @returns {Promise<Answer>}
 */
export function act(
  command,
  fields,
  { quiet = false, errors = "toast", step = 0, isDirect = false } = {},
) {
  const refusal = why(command, fields);
  if (!refusal && !isDirect) {
    const answer = detours.get(command)?.(fields);
    if (answer) return answer;
  }
  const answer = refusal
    ? Promise.resolve({ level: "error", text: refusal })
    : new Promise((resolve) => waiting.set(send(command, fields, step), resolve));
  answer.then(({ level, text }) => {
    const isShown = level === "error" ? errors === "toast" : !quiet;
    if (text && isShown) toast(text, { level });
  });
  return answer;
}

/**
 * Sends a command whose answers are not waited for: there may be none or several. Returns the number
 * that they have, for a listener of `onAnswer`.
 *
 * @template {keyof Commands} C
 * @param {C} command
 * @param {Commands[C]} [fields]
 */
export function send(command, fields, step = 0) {
  const number = nextNumber();
  const request = { type: "CommandRequest", number, command, arguments: fields ?? {}, step };
  channel.send(/** @type {CommandRequest} */ (request));
  return number;
}

/**
 * Calls `listener` with each answer to a command.
 *
 * @param {keyof Commands} command
 * @param {(result: CommandResult) => void} listener
 */
export const onAnswer = (command, listener) => listeners.set(command, listener);

/**
 * Lets `take(fields)` have a command before it is sent; what it returns is the answer, null to send it.
 *
 * @template {keyof Commands} C
 * @param {C} command
 * @param {(fields: Commands[C]) => Promise<Answer> | null} take
 */
export const detour = (command, take) => detours.set(command, take);

/** A number for commands that are undone together. */
export const newStep = nextNumber;
