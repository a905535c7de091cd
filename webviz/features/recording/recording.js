// Buttons for live topics: record them, and save the last minute.

import { needs } from "../../access.js";
import { act } from "../../act.js";
import { el, set, setText } from "../../dom.js";
import { icon } from "../../icons.js";
import { provide } from "../../commands.js";
import { timeBarButton } from "../../shell/time_bar.js";
import { duration } from "../../time_text.js";
import { watch } from "../../stores.js";

/** @import {RunningRecording} from "../../contents.js" */

export const install = () => timeBarButton(buttons());

/** The buttons; hidden for a bag. */
function buttons() {
  /** @type {RunningRecording | null | undefined} */
  let recording = null;
  let isLive = false;
  let isRemembering = false;
  let saved = "";

  const start = el("button", { type: "button", class: "wv-button wv-record", onclick: toggle });
  const label = el("span", { class: "wv-number" });
  start.append(icon("record", 12), label);
  const save = el(
    "button",
    { type: "button", class: "wv-button wv-save-last", onclick: saveLast },
    icon("save", 14),
  );
  const span = el("span", { class: "wv-number" });
  const memory = el("span", { class: "wv-quiet wv-memory wv-number", tabindex: 0 });
  save.append(span);
  const element = el(
    "div",
    { class: "wv-recorder", hidden: true },
    memory,
    needs("StartRecording", start),
    needs("SaveMemory", save),
  );

  function toggle() {
    return act(recording ? "StopRecording" : "StartRecording");
  }

  function saveLast() {
    return act("SaveMemory");
  }

  watch("recording", (values) => {
    isLive = values.has("remembered");
    element.hidden = !isLive;
    if (!isLive) return;
    recording = values.get("recording");
    isRemembering = values.get("is_remembering") === true;
    const [seconds, megabytes] = values.get("remembered") ?? [0, 0];
    const held = values.get("held") ?? null;
    saved = held === null ? `last ${seconds} s` : `all ${held} s`;
    set(start, {
      "data-recording": recording !== null,
      "aria-label": recording ? "Stop recording" : "Record",
      "data-tip": recording
        ? `Recording to ${recording.name}, ${recording.megabytes} MB. Click to stop.`
        : "Record all topics that are displayed, in the working folder of webviz",
    });
    setText(
      label,
      recording ? `${duration(recording.seconds, 0)} · ${recording.megabytes} MB` : "Record",
    );
    setText(memory, isRemembering ? `memory ${seconds} s, ${megabytes} MB` : "no memory");
    set(memory, { "data-tip": values.get("about") });
    save.hidden = !isRemembering;
    setText(span, `Save ${saved}`);
    set(save, {
      "aria-label": `Save ${saved}`,
      "data-tip":
        held === null
          ? `Save what is remembered of the displayed topics: ${seconds} s, ${megabytes} MB`
          : `Save the ${held} s of the timeline, with the moment that is shown`,
    });
  });

  provide(() => {
    if (!isLive) return [];
    const group = "Time";
    const name = recording ? "Stop recording" : "Record";
    const commands = [{ name, icon: "record", group, needs: "StartRecording", run: toggle }];
    if (isRemembering)
      commands.push({
        name: `Save ${saved}`,
        icon: "save",
        group,
        needs: "SaveMemory",
        run: saveLast,
      });
    return commands;
  });
  return element;
}
