// Stands in for the server of a page that was exported: answers from the recorded run what a viewer
// would, and refuses the rest.

import { clock } from "webviz/recorded/clock.js";
import { Player } from "webviz/recorded/player.js";
import { boxOf } from "webviz/recorded/bounds.js";
import { frameAt } from "webviz/recorded/moments.js";
import { selection } from "webviz/recorded/selection.js";
import { views } from "webviz/recorded/views.js";

/** @import {CommandRequest, CommandResult, FromPage, ToPage} from "webviz/messages.js" */
/** @import {Socket} from "webviz/channel.js" */
/** @import {ViserMessage} from "webviz/types.js" */
/** @import {About} from "webviz/recorded/types.js" */

/** @typedef {Record<string, (fields: any) => unknown>} Acts what commands do, by name */

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
  const socket = makeSocket((message) => answer(message));
  /** @param {ToPage} message */
  const deliver = (message) => socket.onmessage?.({ data: JSON.stringify(message) });
  const panes = pictureSender((data) => socket.onmessage?.({ data }));
  /** @type {Promise<void>} */
  let applied = Promise.resolve();
  const run = new Player(about, {
    scene: (messages) => (applied = feed(messages)),
    store: (store, all, set, gone) => deliver({ type: "Values", store, all, set, gone }),
    pictures: panes.offer,
  });
  /** @param {number} at */
  const show = async (at) => {
    try {
      await run.show(at);
      await applied;
    } catch (error) {
      fail(error); // and other times can still be shown
    }
  };
  const time = clock(about.duration, show, () => own.update(["clock", "playback"]));
  const view = views(about, deliver, () => own.update(["view:0", "view_type:0"]));
  const picked = selection(
    (display) => run.value("displays", display),
    (display, node) => run.read(`values:${display}`, node),
    () => `${run.ros().toFixed(3)} s`,
  );
  const own = ownStores(about, deliver, {
    clock: () => clockValues(run.ros(), time.state()),
    playback: () => playbackValues(about, time.state()),
    // Of this page alone, whose number is 0.
    "selected:0": picked.selected,
    "selection:0": picked.selection,
    "view:0": view.view,
    "view_type:0": view.type,
  });
  const acts = {
    ...timeActs(about, time),
    ...view.acts,
    ...sceneActs(run, view, deliver),
    Select: (/** @type {any} */ fields) =>
      picked.select(fields).then(() => own.update(["selected:0", "selection:0"])),
  };

  const answer = answers({ own, run, acts, panes, deliver });
  const begun = time.seek(about.at);
  return {
    socket,
    /** To be called once the page listens to the socket. */
    async open() {
      socket.onopen?.(null);
      deliver({ type: "Identity", role: "recording", name: "" });
      await begun;
      for (const message of about.greeting) deliver(message);
    },
  };
}

/**
 * @param {(message: FromPage) => void} hear
 * @returns {Socket}
 */
const makeSocket = (hear) => ({
  readyState: WebSocket.OPEN,
  binaryType: "arraybuffer",
  onopen: null,
  onclose: null,
  onmessage: null,
  close() {},
  send: (text) => hear(JSON.parse(text)),
});

/**
 * Answers what a page sends.
 *
 * @param {{
 *   own: ReturnType<typeof ownStores>, run: Player, acts: Acts,
 *   panes: ReturnType<typeof pictureSender>, deliver: (message: ToPage) => void,
 * }} viewer
 * @returns {(message: FromPage) => void}
 */
const answers = ({ own, run, acts, panes, deliver }) =>
  function answer(message) {
    if (message.type === "Watch") {
      if (!own.watch(message.store)) run.watch(message.store);
    } else if (message.type === "Unwatch") {
      own.unwatch(message.store);
      run.unwatch(message.store);
    } else if (message.type === "CommandRequest") carryOut(acts, message).then(deliver);
    else if (message.type === "ShowPictures")
      panes.show(Object.keys(message.widths), (display) => run.repeat(display));
    else if (message.type === "FramesShown") panes.confirm(Object.keys(message.numbers));
    else if (message.type === "Ping") deliver({ type: "Pong" });
  };

/**
 * Sends the pictures of the panes that are shown, as many at a time as a viewer would.
 *
 * @param {(data: ArrayBuffer) => void} send
 */
function pictureSender(send) {
  /** @type {Map<string, {underway: number, next: (() => ArrayBuffer)[] | null}>} */
  const panes = new Map();

  /** @param {string} display */
  function sendNext(display) {
    const pane = panes.get(display);
    if (!pane?.next || pane.underway >= MAX_IN_FLIGHT) return;
    const factories = pane.next;
    pane.next = null;
    for (const make of factories) {
      pane.underway += 1;
      send(make());
    }
  }

  return {
    /**
     * The pictures of a display have come, in place of those that were not sent yet.
     *
     * @param {string} display
     * @param {(() => ArrayBuffer)[]} factories
     */
    offer(display, factories) {
      const pane = panes.get(display);
      if (!pane) return;
      pane.next = factories;
      sendNext(display);
    },
    /**
     * Shows these displays and no others; `repeat` offers what a new one has now.
     *
     * @param {string[]} displays
     * @param {(display: string) => unknown} repeat
     */
    show(displays, repeat) {
      for (const display of panes.keys()) if (!displays.includes(display)) panes.delete(display);
      for (const display of displays) {
        if (panes.has(display)) continue;
        panes.set(display, { underway: 0, next: null });
        repeat(display);
      }
    },
    /** @param {string[]} displays whose pictures the page has shown */
    confirm(displays) {
      for (const display of displays) {
        const pane = panes.get(display);
        if (pane) pane.underway = 0;
        sendNext(display);
      }
    },
  };
}

/**
 * The stores that are made here, and those that do not change.
 *
 * @param {About} about
 * @param {(message: ToPage) => void} deliver
 * @param {Record<string, () => Record<string, unknown>>} factories
 */
function ownStores(about, deliver, factories) {
  /** @type {Set<string>} */
  const watched = new Set();
  /**
   * @param {string} store
   * @param {Record<string, unknown>} set
   */
  const send = (store, set) => deliver({ type: "Values", store, all: true, set, gone: [] });
  /** @param {string} name */
  const updateOne = (name) => send(name, factories[name]?.() ?? about.stores[name] ?? {});
  return {
    /** @param {string[]} names */
    update(names) {
      for (const name of names) if (watched.has(name)) updateOne(name);
    },
    /**
     * Sends a store, and when it changes; false for one that the run has.
     *
     * @param {string} name
     */
    watch(name) {
      if (name in factories || name in about.stores) {
        watched.add(name);
        updateOne(name);
      } else if (NOT_RECORDED.test(name)) send(name, { problem: NO_VALUES });
      else return false;
      return true;
    },
    unwatch: (/** @type {string} */ name) => watched.delete(name),
  };
}

/**
 * @param {number} ros
 * @param {ReturnType<ReturnType<typeof clock>["state"]>} state
 */
function clockValues(ros, { isPlaying, rate }) {
  const wall = Date.now() / 1000;
  return {
    pace: [ros, wall, isPlaying ? rate : 0],
    began: [0, wall],
    is_known: ros !== 0,
    is_paused: !isPlaying,
    is_simulated: true,
    hz: 0,
  };
}

/**
 * @param {About} about
 * @param {ReturnType<ReturnType<typeof clock>["state"]>} state
 */
function playbackValues({ names, start, duration }, { position, isPlaying, rate, loop, selected }) {
  const recording = { names, start, duration, rate, loop, selected, is_live: null };
  return { ...recording, is_playing: isPlaying, position: Math.round(position * 1e3) / 1e3 };
}

/**
 * @param {About} about
 * @param {ReturnType<typeof clock>} time
 * @returns {Acts}
 */
const timeActs = ({ duration, index }, time) => ({
  Pause: ({ paused = true }) => time.pause(paused),
  Play: () => time.pause(false),
  Seek: ({ at_s }) => time.seek(at_s),
  SetRate: ({ rate }) => time.set({ rate }),
  SetLoop: ({ loop = true }) => time.set({ loop }),
  SelectSpan({ first_s, last_s }) {
    const selected = [first_s ?? 0, Math.min(last_s ?? duration, duration)];
    const isAll = first_s === null && last_s === null;
    time.set({ selected: isAll ? null : /** @type {[number, number]} */ (selected) });
  },
  StepMessage({ is_forward = true }) {
    time.pause(true);
    const at = neighbour(index, time.state().position, is_forward);
    if (at === undefined) throw new Error(NEVER);
    return time.seek(at);
  },
});

/**
 * @param {Player} run
 * @param {ReturnType<typeof views>} view
 * @param {(message: ToPage) => void} deliver
 * @returns {Acts}
 */
const sceneActs = (run, view, deliver) => ({
  FocusDisplay({ display }) {
    const box = boxOf(run.within(display));
    if (!box) throw new Error("This display draws nothing to focus on. Check its statuses.");
    view.lookAt(box);
  },
  SaveImage: ({ name = "" }) => deliver({ type: "SaveCanvas", name }),
  SetProperty: ({ display, value }) => run.enable(display, value),
  Identify: () => {},
});

/**
 * The time of the frame before or after a time; undefined for none.
 *
 * @param {About["index"]} index
 * @param {number} position
 * @param {boolean} isForward
 */
function neighbour(index, position, isForward) {
  const [chunk, frame] = frameAt(index, position);
  const { times } = index[chunk];
  if (isForward) return times[frame + 1] ?? index[chunk + 1]?.times[0];
  return times[frame - 1] ?? index[chunk - 1]?.times.at(-1);
}

/**
 * @param {Acts} acts
 * @param {CommandRequest} request
 * @returns {Promise<CommandResult>}
 */
async function carryOut(acts, { number, command, arguments: fields }) {
  let [level, text] = ["ok", ""];
  try {
    const act = acts[command];
    if (!act) throw new Error(REASON);
    await act(fields);
  } catch (error) {
    [level, text] = ["error", error instanceof Error ? error.message : String(error)];
  }
  return { type: "CommandResult", number, command, level, text, result: {} };
}
