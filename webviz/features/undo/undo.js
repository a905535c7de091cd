// Undo and redo: buttons, keys and menus, and a word on what others have changed.

import { needs, why } from "webviz/access.js";
import { act } from "webviz/act.js";
import * as channel from "webviz/channel.js";
import { command } from "webviz/commands.js";
import { iconButton } from "webviz/icons.js";
import { action } from "webviz/shell/actions.js";
import { headButton } from "webviz/shell/header.js";
import { store, watch } from "webviz/stores.js";
import { openMenuBelow } from "webviz/controls/menu.js";
import { toast } from "webviz/toasts.js";

/** @import {HistoryStep} from "webviz/contents.js" */
/** @import {MenuItem} from "webviz/controls/menu.js" */

/** @typedef {"undo" | "redo"} Way */

const MAX_LISTED = 30;
const history = store("history");
/** @param {Way} way */
const steps = (way) => history.get(way) ?? [];

export function install() {
  announceSteps();
  const undone = step("undo", UNDO);
  headButton(undone);
  headButton(step("redo", REDO));
  command(UNDO);
  command(REDO);
  action({
    name: "Undo and redo steps…",
    icon: "clock",
    group: "Edit",
    run: () => openSteps(undone),
  });
}

/**
 * The subject of the next step of a way, "undo" or "redo"; undefined if there is none. It is read in
 * effects.
 *
 * @param {Way} way
 */
const next = (way) => (steps(way).find(isOwn) ?? steps(way)[0])?.label;

/** Takes back the newest step of this page; without one, the newest of all. */
const undo = () => steps("undo").length && act("Undo", { own: true });
const redo = () => steps("redo").length && act("Redo", { own: true });

const UNDO = {
  name: "Undo",
  icon: "arrow-back",
  key: ["Ctrl+z"],
  group: "Edit",
  needs: "Undo",
  run: undo,
};
const REDO = {
  name: "Redo",
  icon: "arrow-forward",
  key: ["Ctrl+Shift+z", "Ctrl+y"],
  group: "Edit",
  needs: "Redo",
  run: redo,
};

/**
 * Its tooltip names the step to undo; all steps are in a menu, by a right click or the arrow key.
 *
 * @param {Way} way
 * @param {typeof UNDO} action
 */
function step(way, action) {
  const label = () => next(way);
  const isLocked = () => why(action.needs) !== ""; // then a click says why
  /** @param {Event} event */
  const open = (event) => {
    event.preventDefault();
    openSteps(button);
  };
  /** @type {HTMLButtonElement} */
  const button = iconButton(action.icon, action.name, action.run, {
    "data-key": action.key[0],
    disabled: () => !isLocked() && label() === undefined,
    tip: null,
    "data-tip": () => (label() === undefined ? action.name : `${action.name}: ${label()}`),
    oncontextmenu: open,
    onkeydown: (/** @type {KeyboardEvent} */ event) => event.key === "ArrowDown" && open(event),
  });
  return needs(action.needs, button);
}

/** @param {HistoryStep} step */
const isOwn = ({ browser }) => browser === window.webviz.browser;

/**
 * A menu of steps below a button: the one that is chosen, and all that came after it.
 *
 * @param {HTMLElement} button
 */
function openSteps(button) {
  const redos = steps("redo")
    .slice(0, MAX_LISTED)
    .map(({ label }, index) => ({
      label: `Redo ${label}`,
      icon: "arrow-forward",
      run: () => act("Redo", { steps: index + 1 }),
    }));
  const undos = steps("undo")
    .slice(0, MAX_LISTED)
    .map(({ label }, index) => ({
      label: `Undo ${label}`,
      icon: "arrow-back",
      run: () => act("Undo", { steps: index + 1 }),
    }));
  const all = [...redos.reverse(), ...(redos.length && undos.length ? [null] : []), ...undos];
  openMenuBelow(button, all.length ? all : [{ label: "Nothing to undo", disabled: true }]);
}

/** Says what is new among the steps, whose numbers grow, also when they are taken back. */
function announceSteps() {
  /** @type {number | null} */
  let newest = null;
  // Steps of a viewer that was started anew have other numbers.
  channel.onOpen(() => (newest = null));
  watch("history", () => {
    const [last] = [...steps("undo"), ...steps("redo")].toSorted((a, b) => b.number - a.number);
    const before = newest;
    newest = Math.max(newest ?? -1, last?.number ?? -1);
    if (before === null) announceRestored(steps("undo")[0]);
    else if (newest !== before && last) announceStep(last);
  });
}

/** @param {HistoryStep} last the newest of all */
function announceStep(last) {
  const isUndone = steps("redo").includes(last);
  if (last.browser !== window.webviz.browser) {
    const text = `${isUndone ? "Undone" : "Changed"} ${whereOf(last)}: ${last.label}`;
    toast(text, { topic: "others" }); // dragging a slider makes many steps
  } else if (!isUndone && last.removed) {
    const action = { label: "Undo", run: undo };
    toast(`Removed ${last.removed}.`, { topic: "removed", action });
  }
}

/**
 * The page is opened, and nothing has been changed since the viewer started.
 *
 * @param {HistoryStep} [last]
 */
function announceRestored(last) {
  if (!last?.restored) return;
  const action = why("Undo") ? null : { label: "Undo", run: undo };
  const text = `Restored ${last.restored} of the last session.`;
  toast(text, { level: "warn", topic: "restored", action });
}

/** @param {HistoryStep} step */
const whereOf = ({ browser }) => (browser === null ? "by a program" : "in another browser");
