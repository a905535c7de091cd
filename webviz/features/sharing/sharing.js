// "Share this moment": what is shown, and the time around it, as one file that opens without webviz.

import { needs, onRole, why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { openDialog } from "webviz/controls/dialog.js";
import { el, newId } from "webviz/dom.js";
import { icon, textButton } from "webviz/icons.js";
import { overlay } from "webviz/overlay/overlay.js";
import { action } from "webviz/shell/actions.js";
import { timeBarButton } from "webviz/shell/time_bar.js";
import { effect, root, signal } from "webviz/signals.js";
import { store, watch } from "webviz/stores.js";
import { toast } from "webviz/toasts.js";

/** @import {Signal} from "webviz/signals.js" */

/** Seconds before and after the moment; null for what is shared unless one chooses. @typedef {[number, number] | null} Span */

const NAME = "Share this moment";
const TIP = "Make one file of what you see, which opens in any browser without webviz";
const QUIET = /** @type {const} */ ({ quiet: true, errors: "caller" });
const ABOUT =
  "One HTML file of at most 50 MB, which this browser downloads and webviz keeps in its working " +
  "folder. It opens in any browser, without webviz or a network, and contains:";
/** @type {[string, Span][]} */
const OF_BAG = [
  ["30 s before and 5 s after, or the span selected on the timeline", null],
  ["10 s before and 5 s after", [10, 5]],
  ["2 min before and 30 s after", [120, 30]],
];
/** @type {[string, Span][]} */
const OF_LIVE = [
  ["All that is remembered", null],
  ["The last 30 s", [30, 0]],
  ["The last 10 s", [10, 0]],
];

const playback = store("playback");
const sharing = store("sharing");
const maySee = signal(false); // once the role of this page is known; others are refused to watch it

/** The share of the work that is done while a file is made, else null; read in effects. */
const workShare = () => (maySee.value ? (sharing.get("share") ?? null) : null);
const isBag = () => playback.get("is_live") === null;

export function install() {
  const mine = signal(false); // whether this page has asked for the file
  timeBarButton(button(mine));
  action({
    ...{ name: `${NAME}…`, icon: "upload", group: "Time", needs: "ShareMoment" },
    run: () => openShare(mine),
  });
  onRole(() => {
    if (why("ShareMoment")) return;
    maySee.value = true;
    overlay("cards", "sharing", progress());
    tellEnds(mine);
  });
}

/** Says how each file has ended, and downloads that of this page.
 *
 * @param {Signal<boolean>} mine
 */
function tellEnds(mine) {
  const last = { number: -1 };
  watch("sharing", (values) => {
    const number = values.get("number");
    if (number === undefined) return;
    if (last.number >= 0 && number > last.number) {
      const level = values.get("level");
      const isMade = level === "ok";
      const action = isMade ? { label: "Download", run: fetchFile } : null;
      // The card of a file says it on the page that has asked for it.
      if (!isMade || !mine.value) toast(values.get("text") ?? "", { level, action });
      if (isMade && mine.value) fetchFile();
      mine.value = false;
    }
    last.number = number;
  });
}

/** How far the file is, with a button that cancels it. */
const progress = () =>
  el(
    "section",
    { class: "wv-card wv-sharing", role: "status", hidden: () => workShare() === null },
    el("progress", { max: 1, value: () => workShare() ?? 0, "aria-label": "Share of the file" }),
    el("span", {}, () => `Sharing… ${Math.round((workShare() ?? 0) * 100)} %`),
    textButton("Cancel", () => act("StopSharing")),
  );

/**
 * The button; hidden where there is nothing to share, and in a file that was shared.
 *
 * @param {Signal<boolean>} mine
 */
const button = (mine) =>
  needs(
    "ShareMoment",
    el(
      "button",
      {
        type: "button",
        class: "wv-button wv-share",
        hidden: () => !playback.has("start") || Boolean(window.webvizRun),
        disabled: () => workShare() !== null,
        "data-alone": () => isBag() && !playback.get("is_opened"),
        "data-tip": TIP,
        "aria-label": NAME,
        onclick: () => openShare(mine),
      },
      icon("upload", 14),
      el("span", { class: "wv-number" }, NAME),
    ),
  );

/** Downloads the last file that was made; the page may be at a path of a proxy. */
const fetchFile = () => el("a", { href: "shared", download: "" }).click();

/** @param {Span} span */
const fieldsOf = (span) => (span ? { before_s: span[0], after_s: span[1] } : {});

/**
 * Shows what a file would contain; begins to make it once that is confirmed.
 *
 * @param {Signal<boolean>} mine
 */
const openShare = (mine) =>
  root(async (end) => {
    /** @type {Signal<Span>} */
    const span = signal(/** @type {Span} */ (null));
    const problem = signal("");
    async function begin() {
      const { level, text } = await act("ShareMoment", fieldsOf(span.value), QUIET);
      problem.value = level === "error" ? text : "";
      mine.value = level !== "error";
      return mine.value;
    }
    await openDialog({
      title: NAME,
      className: "wv-report-dialog",
      content: [
        spans(span),
        el("p", { class: "wv-quiet" }, ABOUT),
        contents(span, problem),
        el("p", { class: "wv-problem", role: "alert" }, problem),
      ],
      buttons: [
        { label: "Cancel", value: null },
        { label: "Share", value: true, primary: true, accept: begin },
      ],
    });
    end();
  });

/**
 * The choice of the time span; the past of live topics is shared as a whole.
 *
 * @param {Signal<Span>} span
 */
function spans(span) {
  const name = newId("span");
  const choices = isBag() ? OF_BAG : playback.get("is_live") ? OF_LIVE : [];
  return el(
    "fieldset",
    { class: "wv-spans", hidden: !choices.length },
    el("legend", {}, "Time"),
    choices.map(([label, value], i) => {
      const choose = () => {
        span.value = value;
      };
      return el(
        "label",
        {},
        el("input", { type: "radio", name, checked: i === 0, onchange: choose }),
        label,
      );
    }),
  );
}

/**
 * The parts of the file with the chosen span.
 *
 * @param {Signal<Span>} span
 * @param {Signal<string>} problem
 */
function contents(span, problem) {
  /** @type {Signal<string[]>} */
  const lines = signal(/** @type {string[]} */ ([]));
  effect(() => {
    const request = span.value;
    act("ListMoment", fieldsOf(request), QUIET).then(({ level, text }) => {
      if (span.value !== request) return; // another was chosen meanwhile
      problem.value = level === "error" ? text : "";
      lines.value = level === "error" ? [] : text.split("\n");
    });
  });
  return el("ul", { class: "wv-report" }, () => lines.value.map((line) => el("li", {}, line)));
}
