// The panel "TF": the tree of frames, and the transform between two of them.

import { act } from "../../act.js";
import { keyOf, rowList, touchable } from "../../controls/rows.js";
import { searchField } from "../../controls/fields.js";
import { el, set, setText, showText } from "../../dom.js";
import { icon, iconButton, textButton } from "../../icons.js";
import { recall, remember } from "../../remember.js";
import { store, watch } from "../../stores.js";
import { needs } from "../../access.js";
import { foldByKey } from "../../panels/folds.js";
import { panel } from "../../panels/panels.js";
import { frameActions, wantedFrame } from "../../panels/frame_actions.js";
import { between } from "./frame_between.js";
import { openFramePicture } from "./frame_picture.js";
import {
  ageText,
  factOf,
  frameNames,
  frameRows,
  makeFrame,
  updateFrame,
} from "../../panels/frame_rows.js";

/** @import {FrameRow} from "../../panels/frame_rows.js" */
/** @import {Panel, ValuesOf} from "../../types.js" */

const ROW_PX = 26;
const NOTHING = "No transforms yet on /tf or /tf_static.";

export const install = () => panel(transforms);

/** @type {Panel} */
const transforms = {
  name: "transforms",
  title: "TF",
  order: 40,
  open(element) {
    /** @type {ValuesOf<"transforms"> | null} */
    let values = null;
    /** @type {Set<string>} */
    const folded = new Set(recall("tf-folded", []));

    const search = searchField("Filter frames", show);
    const list = rowList({
      label: "Frames",
      role: "tree",
      rowRole: "treeitem",
      height: touchable(ROW_PX),
      make: makeFrame,
      update: updateFrame,
      choose,
      onKey,
    });
    list.element.addEventListener("click", onFold, { capture: true });
    const picture = iconButton("tree", "Show the tree as a picture", () =>
      openFramePicture((name, frame) => detailOf({ name, frame })),
    );
    const problems = el("div", {
      class: "wv-tf-problems",
      role: "status",
      hidden: true,
      "data-level": "warn",
    });
    const empty = el("div", { class: "wv-empty", role: "status", hidden: true });
    const facts = el("div");
    const actions = frameActions.map(({ label, tip, needs: command, isFor, run }) => {
      const button = textButton(label, () => run(list.marked()?.name ?? ""), { tip });
      return { isFor, button: needs(command, button) };
    });
    const detail = el(
      "div",
      { class: "wv-frame-detail", hidden: true },
      facts,
      actions.map(({ button }) => button),
    );
    const pair = between(() => frameNames(store("transforms").all()));
    element.append(
      el(
        "div",
        { class: "wv-tf" },
        el("div", { class: "wv-search wv-frame-search" }, icon("search"), search, picture),
        problems,
        empty,
        list.element,
        detail,
        pair,
      ),
    );

    function show() {
      if (!values?.has("/roots")) return;
      const rows = frameRows(values, folded, search.value);
      list.show(rows);
      const wanted = wantedFrame();
      const row = rows.find(({ name }) => name === wanted);
      if (row) list.mark(row.key);
      const hasFrames = (values.get("/roots") ?? []).length > 0;
      setText(empty, hasFrames ? "No matching frames." : NOTHING);
      set(empty, { hidden: rows.length > 0 });
      const sentences = (values.get("/problems") ?? []).join(" ");
      showText(problems, sentences);
      showDetail();
    }

    function showDetail() {
      const row = list.marked();
      set(detail, { hidden: !row });
      if (row) setText(facts, detailOf(row));
      for (const { button, isFor } of actions)
        set(button, { hidden: !row?.frame || !isFor(row.frame) });
    }

    /** @param {FrameRow} row */
    function choose(row) {
      showDetail();
      act("FocusFrame", { frame: row.name });
    }

    /** @param {string} name */
    function toggle(name) {
      if (!folded.delete(name)) folded.add(name);
      remember("tf-folded", [...folded]);
      show();
    }

    /**
     * A click on the mark folds, and leaves the camera where it is.
     *
     * @param {MouseEvent} event
     */
    function onFold(event) {
      const mark = /** @type {Element} */ (event.target).closest(".wv-fold-mark");
      if (!mark?.closest(".wv-row")?.hasAttribute("aria-expanded")) return;
      event.stopPropagation();
      const key = keyOf(mark);
      toggle(key.slice(key.lastIndexOf("\n") + 1));
    }

    /**
     * @param {KeyboardEvent} event
     * @param {FrameRow} row
     * @returns {boolean}
     */
    function onKey({ key }, row) {
      return foldByKey(key, row, ({ name }) => toggle(name), list, "\n");
    }

    const end = watch("transforms", (all) => {
      values = all;
      show();
    });
    return () => {
      end();
      list.close();
    };
  },
};

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
