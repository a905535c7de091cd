// Stands in for the server of a page that was exported: answers from the recorded run what a viewer
// would, and refuses the rest.

import { clock } from "webviz/recorded/clock.js";
import { player } from "webviz/recorded/player.js";
import { boxOf } from "webviz/recorded/bounds.js";
import { frameAt } from "webviz/recorded/moments.js";
import { selection } from "webviz/recorded/selection.js";
import { views } from "webviz/recorded/views.js";

/** @import {Do, FromPage, ToPage} from "webviz/messages.js" */
/** @import {Socket} from "webviz/channel.js" */
/** @import {ViserMessage} from "webviz/types.js" */
/** @import {About} from "webviz/recorded/types.js" */

const MAX_IN_FLIGHT = 2;
/** Stores of what a page asks for: they are too many to record. */
const NOT_RECORDED = /^(between|message):/;
const NO_VALUES = "This is not in the file. Open the bag in webviz to see it.";
const NEVER = "There is no other message in this recording. Step in the other direction.";

const REASON =
  "This page is a recording and cannot be changed. Open the bag in webviz to change it.";

/** The commands that are carried out here. */
const COMMANDS = new Set([
  ...["Pause", "Play", "Seek", "SelectSpan", "SetLoop", "SetRate", "StepMessage"],
  ...["ChangeView", "FocusDisplay", "FocusFrame", "ResetView", "SaveImage", "ShowView"],
  ...["Identify", "Select"],
]);

/**
 * Return why a command is not allowed: a sentence, "" if it is. Displays can only be switched.
 *
 * @param {string} what
 * @param {{path?: string}} fields
 */
export function refusal(what, { path }) {
  const isSwitch = what === "SetProperty" && path === "enabled";
  return isSwitch || COMMANDS.has(what) ? "" : REASON;
}

/**
 * Returns a socket that a run answers, and what opens it. `feed(messages)` passes messages to viser's page, and resolves once it
 * has applied them.
 *
 * @param {About} about
 * @param {(messages: ViserMessage[]) => Promise<void>} feed
 * @param {(error: unknown) => void} fail called when a part of the file cannot be shown
 */
export function connection(about, feed, fail) {
  /** @type {Set<string>} */
  const own = new Set(); // names of watched stores that are made here
  /** @type {Map<string, {waiting: number[], next: (() => ArrayBuffer)[] | null}>} */
  const panes = new Map(); // that are shown
  /** @type {Promise<void>} */
  let applied = Promise.resolve();

  /** @type {Socket} */
  const socket = {
    readyState: WebSocket.OPEN,
    binaryType: "arraybuffer",
    onopen: null,
    onclose: null,
    onmessage: null,
    close() {},
    send: (text) => hear(JSON.parse(text)),
  };

  /** @param {ToPage} message */
  const tell = (message) => socket.onmessage?.({ data: JSON.stringify(message) });

  const run = player(about, {
    scene: (messages) => (applied = feed(messages)),
    store: (store, all, set, gone) => tell({ type: "Values", store, all, set, gone }),
    pictures(display, makers) {
      const pane = panes.get(display);
      if (!pane) return;
      pane.next = makers;
      sendPictures(display);
    },
  });
  const time = clock(about.duration, show, tellTime);
  const view = views(about, tell, tellView);
  const picked = selection(
    (display) => run.value("displays", display),
    (display, node) => run.read(`values:${display}`, node),
    () => `${run.ros().toFixed(3)} s`,
  );

  /** @param {number} at */
  async function show(at) {
    try {
      await run.show(at);
      await applied;
    } catch (error) {
      fail(error); // and other times can still be shown
    }
  }

  /** @param {string} display */
  function sendPictures(display) {
    const pane = panes.get(display);
    if (!pane?.next || pane.waiting.length >= MAX_IN_FLIGHT) return;
    const makers = pane.next;
    pane.next = null;
    for (const make of makers) {
      pane.waiting.push(0);
      socket.onmessage?.({ data: make() });
    }
  }

  /** @type {Record<string, () => Record<string, unknown>>} */
  const MAKERS = {
    clock() {
      const { isPlaying, rate } = time.state();
      const wall = Date.now() / 1000;
      return {
        pace: [run.ros(), wall, isPlaying ? rate : 0],
        began: [0, wall],
        is_known: run.ros() !== 0,
        is_paused: !isPlaying,
        is_simulated: true,
        hz: 0,
      };
    },
    playback() {
      const { position, isPlaying, rate, loop, selected } = time.state();
      const { names, start, duration } = about;
      const recording = { names, start, duration, rate, loop, selected, is_live: null };
      return { ...recording, is_playing: isPlaying, position: Math.round(position * 1e3) / 1e3 };
    },
  };

  // Of this page alone, whose number is 0.
  /** @type {Record<string, () => Record<string, unknown>>} */
  const PERSONAL = {
    "selected:0": picked.selected,
    "selection:0": picked.selection,
    "view:0": view.view,
    "view_type:0": view.type,
  };

  function tellView() {
    tellAll(["view:0", "view_type:0"]);
  }

  /** @param {string[]} names */
  function tellAll(names) {
    for (const name of names) if (own.has(name)) tellOwn(name);
  }

  /** @param {string} name */
  function tellOwn(name) {
    const make = MAKERS[name] ?? PERSONAL[name];
    const set = make ? make() : about.stores[name];
    tell({ type: "Values", store: name, all: true, set: set ?? {}, gone: [] });
  }

  function tellTime() {
    tellAll(Object.keys(MAKERS));
  }

  /** @param {string} name */
  function watch(name) {
    if (name in MAKERS || name in PERSONAL || name in about.stores) {
      own.add(name);
      tellOwn(name);
    } else if (NOT_RECORDED.test(name)) {
      tell({ type: "Values", store: name, all: true, set: { problem: NO_VALUES }, gone: [] });
    } else run.watch(name);
  }

  /** @type {Record<string, (fields: any) => unknown>} */
  const ACTS = {
    Pause: ({ paused = true }) => time.pause(paused),
    Play: () => time.pause(false),
    Seek: ({ at_s }) => time.seek(at_s),
    SetRate: ({ rate }) => time.set({ rate }),
    SetLoop: ({ loop = true }) => time.set({ loop }),
    SelectSpan({ first_s, last_s }) {
      const selected = [first_s ?? 0, Math.min(last_s ?? about.duration, about.duration)];
      const isAll = first_s === null && last_s === null;
      time.set({ selected: isAll ? null : /** @type {[number, number]} */ (selected) });
    },
    StepMessage({ is_forward = true }) {
      time.pause(true);
      const at = neighbour(is_forward);
      if (at === undefined) throw new Error(NEVER);
      return time.seek(at);
    },
    ...view.acts,
    FocusDisplay({ display }) {
      const box = boxOf(run.within(display));
      if (!box) throw new Error("This display draws nothing to focus on. Check its statuses.");
      view.lookAt(box);
    },
    SaveImage: ({ name = "" }) => tell({ type: "SaveCanvas", name }),
    SetProperty: ({ display, value }) => run.enable(display, value),
    Identify: () => {},
    async Select(fields) {
      await picked.select(fields);
      tellAll(["selected:0", "selection:0"]);
    },
  };

  /** @param {boolean} isForward */
  function neighbour(isForward) {
    const { index } = about;
    const [chunk, frame] = frameAt(index, time.state().position);
    const { times } = index[chunk];
    if (isForward) return times[frame + 1] ?? index[chunk + 1]?.times[0];
    return times[frame - 1] ?? index[chunk - 1]?.times.at(-1);
  }

  /** @param {Do} request */
  async function carryOut({ number, command, arguments: fields }) {
    let [level, text] = ["ok", ""];
    try {
      const act = ACTS[command];
      if (!act) throw new Error(REASON);
      await act(fields);
    } catch (error) {
      [level, text] = ["error", error instanceof Error ? error.message : String(error)];
    }
    tell({ type: "Done", number, command, level, text, result: {} });
  }

  /** @param {Record<string, number>} widths */
  function showPictures(widths) {
    for (const display of panes.keys()) if (!(display in widths)) panes.delete(display);
    for (const display of Object.keys(widths)) {
      if (panes.has(display)) continue;
      panes.set(display, { waiting: [], next: null });
      run.repeat(display);
    }
  }

  /** @param {FromPage} message */
  function hear(message) {
    if (message.type === "Watch") watch(message.store);
    else if (message.type === "Unwatch") {
      own.delete(message.store);
      run.unwatch(message.store);
    } else if (message.type === "Do") carryOut(message);
    else if (message.type === "ShowPictures") showPictures(message.widths);
    else if (message.type === "FramesShown") {
      for (const display of Object.keys(message.numbers)) {
        panes.get(display)?.waiting.splice(0);
        sendPictures(display);
      }
    } else if (message.type === "Ping") tell({ type: "Pong" });
  }

  const begun = time.seek(about.at);
  return {
    socket,
    /** To be called once the page listens to the socket. */
    async open() {
      socket.onopen?.(null);
      tell({ type: "You", role: "recording", name: "" });
      await begun;
      for (const message of about.greeting) tell(message);
    },
  };
}
