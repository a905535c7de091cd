// "Share this moment": what is shown, and the time around it, as one file that opens without webviz.

import { needs, onRole, why } from "../../access.js";
import { act } from "../../act.js";
import { el, set, setText } from "../../dom.js";
import { icon } from "../../icons.js";
import { action } from "../../shell/actions.js";
import { openDialog } from "../../controls/dialog.js";
import { timeBarButton } from "../../shell/time_bar.js";
import { toast } from "../../toasts.js";
import { watch } from "../../stores.js";

/** @import {ValuesOf} from "../../types.js" */

const NAME = "Share this moment";
const TIP = "Make one file of what you see, which opens in any browser without webviz";

let isBag = false; // of which a span can be selected
let isAlone = false; // a bag in whose place no live topics can be
/** @type {number | null} */
let done = null; // the share of the work, while a file is made
let isMine = false; // whether this page has asked for it

export function install() {
  timeBarButton(button());
  action({
    name: `${NAME}…`,
    icon: "upload",
    group: "Time",
    needs: "ShareMoment",
    run: toggle,
  });
}

/** Asks whether to share the moment, or stops the file that is being made. */
const toggle = () => (done === null ? openShare() : act("StopSharing"));

/** The button; hidden where there is nothing to share, and in a file that was shared. */
function button() {
  let isThere = false;
  let known = -1; // how many had ended

  const label = el("span", { class: "wv-number" });
  const element = el(
    "button",
    { type: "button", class: "wv-button wv-share", hidden: true, onclick: toggle },
    icon("upload", 14),
    label,
  );

  function show() {
    const isRunning = done !== null;
    element.hidden = !isThere || Boolean(window.webvizRun);
    setText(label, isRunning ? `Sharing… ${Math.round((done ?? 0) * 100)} %` : NAME);
    set(element, {
      "aria-label": isRunning ? "Stop making the file to share" : NAME,
      "data-alone": isAlone,
      "data-tip": isRunning ? "Click to stop" : TIP,
    });
  }

  watch("playback", (values) => {
    isThere = values.has("start");
    isBag = values.get("is_live") === null;
    isAlone = isBag && !values.get("is_opened");
    show();
  });
  /** @param {ValuesOf<"sharing">} values */
  function follow(values) {
    const number = values.get("number");
    if (number === undefined) return;
    done = values.get("share") ?? null;
    if (known >= 0 && number > known) {
      const isMade = values.get("level") === "ok";
      const action = isMade ? { label: "Download", run: fetchFile } : null;
      toast(values.get("text") ?? "", { level: values.get("level"), action });
      if (isMade && isMine) fetchFile();
      isMine = false;
    }
    known = number;
    show();
  }

  onRole(() => {
    if (!why("ShareMoment")) watch("sharing", follow);
  });
  show();

  return needs("ShareMoment", element);
}

/** Downloads the last file that was made; the page may be at a path of a proxy. */
const fetchFile = () => el("a", { href: "shared", download: "" }).click();

/** Shows what a file would contain; begins to make it once that is confirmed. */
function openShare() {
  const list = el("ul", { class: "wv-report" });
  const problem = el("p", { class: "wv-problem", role: "alert" });

  async function show() {
    const { level, text } = await act("ListMoment", {}, { quiet: true, errors: "caller" });
    const isBad = level === "error";
    setText(problem, isBad ? text : "");
    list.replaceChildren(...(isBad ? [] : text.split("\n").map((line) => el("li", {}, line))));
  }

  async function begin() {
    const { level, text } = await act("ShareMoment", {}, { quiet: true, errors: "caller" });
    setText(problem, level === "error" ? text : "");
    isMine = level !== "error";
    if (isMine) toast(text, { level });
    return isMine;
  }

  show();
  return openDialog({
    title: NAME,
    className: "wv-report-dialog",
    content: [
      el(
        "p",
        { class: "wv-quiet" },
        "One HTML file of at most 50 MB, which this browser downloads and webviz keeps in its working " +
          "folder. It opens in any browser, without webviz or a network, and contains:",
      ),
      list,
      el(
        "p",
        { class: "wv-quiet" },
        isBag ? "To share another time span, select it: drag with Shift on the timeline." : "",
      ),
      problem,
    ],
    buttons: [
      { label: "Cancel", value: null },
      { label: "Share", value: true, primary: true, accept: begin },
    ],
  });
}
