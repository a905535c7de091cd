// Buttons for live topics: record them, and save the last minute.

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { el } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { provide } from "webviz/commands.js";
import { timeBarButton } from "webviz/shell/time_bar.js";
import { duration } from "webviz/time_text.js";
import { store } from "webviz/stores.js";

const QUIET = { quiet: true }; // the card of the file says it

export const install = () => timeBarButton(buttons());

/** Of the memory and the recording, read in effects. */
function facts() {
  const values = store("recording");
  const [seconds, megabytes] = values.get("remembered") ?? [0, 0];
  const pastSeconds = values.get("past_s") ?? null;
  return {
    ...{ seconds, megabytes, pastSeconds },
    isLive: values.has("remembered"),
    isRemembering: values.get("is_remembering") === true,
    recording: values.get("recording") ?? null,
    about: values.get("about") ?? "",
    saved: pastSeconds === null ? `last ${seconds} s` : `all ${pastSeconds} s`,
  };
}

const toggle = () => (facts().recording ? act("StopRecording", {}, QUIET) : act("StartRecording"));
const saveLast = () => act("SaveMemory", {}, QUIET);

/** The buttons; hidden for a bag. */
function buttons() {
  const memoryText = () => {
    const { isRemembering, seconds, megabytes } = facts();
    return isRemembering ? `memory ${seconds} s, ${megabytes} MB` : "no memory";
  };
  provide(commands);
  return el(
    "div",
    { class: "wv-recorder", hidden: () => !facts().isLive },
    el(
      "span",
      { class: "wv-quiet wv-memory wv-number", tabindex: 0, "data-tip": () => facts().about },
      memoryText,
    ),
    needs("StartRecording", recordButton()),
    needs("SaveMemory", saveButton()),
  );
}

function recordButton() {
  const recording = () => facts().recording;
  const text = () => {
    const running = recording();
    return running ? `${duration(running.seconds, 0)} · ${running.megabytes} MB` : "Record";
  };
  const tip = () => {
    const running = recording();
    return running
      ? `Recording to ${running.name}, ${running.megabytes} MB. Click to stop.`
      : "Record all topics that are displayed, in the working folder of webviz";
  };
  return el(
    "button",
    {
      type: "button",
      class: "wv-button wv-record",
      "data-recording": () => recording() !== null,
      "aria-label": () => (recording() ? "Stop recording" : "Record"),
      "data-tip": tip,
      onclick: toggle,
    },
    icon("record", 12),
    el("span", { class: "wv-number" }, text),
  );
}

function saveButton() {
  const label = () => `Save ${facts().saved}`;
  const tip = () => {
    const { pastSeconds, seconds, megabytes } = facts();
    return pastSeconds === null
      ? `Save what is remembered of the displayed topics: ${seconds} s, ${megabytes} MB`
      : `Save the ${pastSeconds} s of the timeline, with the moment that is shown`;
  };
  return el(
    "button",
    {
      type: "button",
      class: "wv-button wv-save-last",
      hidden: () => !facts().isRemembering,
      "aria-label": label,
      "data-tip": tip,
      onclick: saveLast,
    },
    icon("save", 14),
    el("span", { class: "wv-number" }, label),
  );
}

function commands() {
  const { isLive, isRemembering, recording, saved } = facts();
  if (!isLive) return [];
  const group = "Time";
  const name = recording ? "Stop recording" : "Record";
  const record = { name, icon: "record", group, needs: "StartRecording", run: toggle };
  const save = {
    ...record,
    name: `Save ${saved}`,
    icon: "save",
    needs: "SaveMemory",
    run: saveLast,
  };
  return isRemembering ? [record, save] : [record];
}
