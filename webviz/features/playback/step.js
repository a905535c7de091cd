// Steps from message to message.

import { act } from "webviz/act.js";

/**
 * Shows the next or previous message of a topic, "" for all that are displayed.
 *
 * @param {string} topic
 * @param {boolean} isForward
 */
export const stepMessage = (topic, isForward) =>
  act("StepMessage", { topic, is_forward: isForward });
