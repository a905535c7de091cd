// The panel "TF": the tree of frames, and the transform between two of them.

import { act } from "webviz/act.js";
import { keyOf, rowList, touchable } from "webviz/controls/rows.js";
import { searchField } from "webviz/controls/fields.js";
import { el } from "webviz/dom.js";
import { icon, iconButton, textButton } from "webviz/icons.js";
import { recall, remember } from "webviz/remember.js";
import { computed, effect, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { needs } from "webviz/access.js";
import { foldByKey } from "webviz/panels/folds.js";
import { panel } from "webviz/panels/panels.js";
import { frameAction, frameActions, wantedFrame } from "webviz/panels/frame_actions.js";
import { between } from "webviz/features/transforms/frame_between.js";
import { openFramePicture } from "webviz/features/transforms/frame_picture.js";
import { ageText, factOf, frameNames, frameRow, frameRows } from "webviz/panels/frame_rows.js";

/** @import {FrameRow} from "webviz/panels/frame_rows.js" */
/** @import {Signal} from "webviz/signals.js" */
/** @import {Panel} from "webviz/types.js" */

const ROW_PX = 26;
const NOTHING = "No transforms yet on /tf or /tf_static.";

export function install() {
  panel(transforms);
  frameAction({
    label: "Look at",
    tip: "Move the camera to this frame (double click, Enter)",
    needs: "FocusFrame",
    isFor: () => true,
    run: lookAt,
  });
}

/** @param {string} frame */
function lookAt(frame) {
  if (frame) act("FocusFrame", { frame });
  return true;
}

const frames = store("transforms");

/** @type {Panel} */
const transforms = {
  name: "transforms",
  title: "TF",
  order: 40,
  open(element) {
    const folded = signal(new Set(/** @type {string[]} */ (recall("tf-folded", []))));
    effect(() => remember("tf-folded", [...folded.value]));
    const text = signal("");
    const rows = computed(() =>
      frames.has("/roots") ? frameRows(frames.all(), folded.value, text.value) : [],
    );
    const isThere = () => frames.has("/roots");
    const problems = () => (isThere() ? (frames.get("/problems") ?? []).join(" ") : "");
    const nothing = () => (frames.get("/roots")?.length ? "No matching frames." : NOTHING);
    const list = frameList(folded);
    effect(() => {
      list.show(rows.value);
      const target = isThere() ? wantedFrame() : null;
      const row = rows.value.find(({ name }) => name === target);
      if (row) list.mark(row.key);
    });
    /** @type {HTMLInputElement} */
    const search = searchField("Filter frames", () => (text.value = search.value));
    const picture = iconButton("tree", "Show the tree as a picture", () =>
      openFramePicture((name, frame) => detailOf({ name, frame })),
    );
    const isEmpty = () => isThere() && !rows.value.length;
    element.append(
      el(
        "div",
        { class: "wv-tf" },
        el("div", { class: "wv-search wv-frame-search" }, icon("search"), search, picture),
        el(
          "div",
          {
            class: "wv-tf-problems",
            role: "status",
            "data-level": "warn",
            hidden: () => !problems(),
          },
          problems,
        ),
        el("div", { class: "wv-empty", role: "status", hidden: () => !isEmpty() }, nothing),
        list.element,
        detail(list.marked),
        between(() => frameNames(frames.all())),
      ),
    );
  },
};

/** @param {Signal<Set<string>>} folded */
function frameList(folded) {
  /** @param {string} name */
  const toggle = (name) => {
    const next = new Set(folded.value);
    if (!next.delete(name)) next.add(name);
    folded.value = next;
  };
  /** @type {ReturnType<typeof rowList<FrameRow>>} */
  const list = rowList({
    label: "Frames",
    role: "tree",
    rowRole: "treeitem",
    height: touchable(ROW_PX),
    row: frameRow,
    onKey: ({ key }, row) =>
      foldByKey(key, row, ({ name }) => toggle(name), list, "\n") ||
      (key === "Enter" && lookAt(row.name)),
  });
  /**
   * A click on the mark folds, and one on a frame marks it; neither moves the camera.
   *
   * @param {MouseEvent} event
   */
  const onclick = (event) => {
    const mark = /** @type {Element} */ (event.target).closest(".wv-fold-mark");
    if (!mark?.closest(".wv-row")?.hasAttribute("aria-expanded")) return;
    event.stopPropagation();
    const key = keyOf(mark);
    toggle(key.slice(key.lastIndexOf("\n") + 1));
  };
  list.element.addEventListener("click", onclick, { capture: true });
  list.element.addEventListener("dblclick", () => lookAt(list.marked()?.name ?? ""));
  return list;
}

/**
 * The facts about the frame that is marked, and the actions on it.
 *
 * @param {() => FrameRow | null} row
 */
function detail(row) {
  const text = () => {
    const marked = row();
    return marked ? detailOf(marked) : "";
  };
  const buttons = frameActions.map(({ label, tip, needs: command, isFor, run }) => {
    const hidden = () => {
      const marked = row();
      return !marked || !isFor(marked.frame);
    };
    return needs(
      command,
      textButton(label, () => run(row()?.name ?? ""), { tip, hidden }),
    );
  });
  return el(
    "div",
    { class: "wv-frame-detail", hidden: () => !row() },
    el("div", {}, text),
    buttons,
  );
}

/**
 * Facts about a frame, in sentences.
 *
 * @param {Pick<FrameRow, "name" | "frame">} row
 */
function detailOf({ name, frame }) {
  if (!frame) return `${name} is a root: it has no parent.`;
  const age = frame.is_static || !frame.samples ? "" : `${ageText(frame)} old`;
  const who = frame.nodes.length ? `from ${frame.nodes.join(", ")}` : "";
  const facts = [`in ${frame.parent || "no frame"}`, factOf(frame), age, who]
    .filter(Boolean)
    .join(", ");
  return [`${name}: ${facts}.`, ...frame.problems].join(" ");
}
