// The widget "log": the lines of a log, filtered in this page.

import { copyAndTell } from "webviz/clipboard.js";
import { combobox } from "webviz/controls/combobox.js";
import { searchField } from "webviz/controls/fields.js";
import { rowList, touchable } from "webviz/controls/rows.js";
import { el, set, setText, showText } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { signal } from "webviz/signals.js";
import { timeOfDay } from "webviz/time_text.js";

/** @import {Page} from "../page/web/extensions.js" */

/**
 * @typedef {{
 *   stamps: number[], levels: number[], names: string[], texts: string[], places: string[],
 * }} Chunk
 * @typedef {{key: string, stamp: number, level: number, name: string, text: string, place: string}} Line
 * @typedef {{chunks: [number, number], problem: string, total: number, beginnings: number,
 *   level: string, nodes: string, text: string}} Values
 */

const LEVELS = ["Debug", "Info", "Warn", "Error", "Fatal"];
const ROW_PX = 20;
const TALL_PX = 36; // with the text below the rest
const NARROW_PX = 480;

/** @param {number} level */
const nameOf = (level) => LEVELS[Math.min(4, Math.max(0, Math.floor(level / 10) - 1))];
/** @param {number} level */
const stateOf = (level) => (level >= 40 ? "error" : level >= 30 ? "warn" : "idle");

/**
 * A line as nodes print it.
 *
 * @param {Line} line
 */
const textOf = ({ stamp, level, name, text }) =>
  `[${nameOf(level).toUpperCase()}] [${stamp.toFixed(6)}] [${name}]: ${text}`;

/** @param {Page} page */
export default function install({ widget }) {
  widget("log", (_, send) => {
    /** @type {{level: string, nodes: string, text: string}} */
    let initial = { level: "", nodes: "", text: "" };
    /** @type {WeakMap<Chunk, Line[]>} */
    let filtered = new WeakMap();
    /** @type {Line[]} */
    let shown = [];
    /** @type {(() => Line[])} */
    let collect = () => [];
    let isFollowing = true;
    let problem = "";
    let total = 0;
    let beginnings = 0;

    const level = signal(LEVELS[0]);
    const lowest = combobox({
      label: "Lowest level",
      value: () => level.value,
      options: () => LEVELS.map((value) => ({ value })),
      change(value) {
        level.value = value;
        filter();
      },
      free: false,
    });
    const nodes = searchField("Node", filter);
    const text = searchField("Text", filter);
    const follow = iconButton("follow", "Follow the newest line", () => setFollowing(!isFollowing));
    const all = iconButton("copy", "Copy the visible lines", () =>
      copyAndTell(shown.map(textOf).join("\n")),
    );
    const count = el("span", { class: "wv-quiet wv-number" });
    const empty = el("div", { class: "wv-empty", role: "status" });
    const detail = el("div", { class: "wv-plugin-detail wv-log-detail", hidden: true });
    const list = rowList({
      label: "Log",
      height: touchable(ROW_PX),
      make: () =>
        el(
          "div",
          { class: "wv-log-row" },
          el("span"),
          el("span", { class: "wv-number" }),
          el("span", { class: "wv-ellipsis" }),
          el("span", { class: "wv-ellipsis" }),
        ),
      update(row, line) {
        const [one, time, name, said] = row.children;
        setText(one, nameOf(line.level));
        set(row, { "data-level": stateOf(line.level) });
        setText(time, timeOfDay(line.stamp, true).split(" ").pop() ?? "");
        setText(name, line.name);
        setText(said, line.text.split("\n", 1)[0]);
      },
      choose: open,
    });
    const canvas = list.element.firstElementChild ?? list.element;
    const sizes = new ResizeObserver(() => {
      const isNarrow = list.element.clientWidth < NARROW_PX;
      set(canvas, { "data-narrow": isNarrow });
      list.resize(touchable(isNarrow ? TALL_PX : ROW_PX));
      toEnd();
    });
    sizes.observe(list.element);
    let top = 0;
    list.element.addEventListener("scroll", () => {
      const { scrollTop, scrollHeight, clientHeight } = list.element;
      const isUp = scrollTop < top;
      // A list that became shorter is scrolled up by the browser, which leaves it at its end.
      if (scrollHeight - scrollTop - clientHeight < (isUp ? 1 : ROW_PX)) mark(true);
      else if (isUp) mark(false);
      top = scrollTop;
    });

    function toEnd() {
      if (!isFollowing) return;
      list.element.scrollTop = list.element.scrollHeight;
      top = list.element.scrollTop; // the browser takes less
    }

    /** @param {Line} line */
    function open(line) {
      const [chunk, place] = line.key.split("/").map(Number);
      detail.replaceChildren(
        el(
          "div",
          { class: "wv-plugin-bar" },
          el("b", { class: "wv-ellipsis" }, `${nameOf(line.level)} of ${line.name}`),
          iconButton("clock", "Go to this time", () => send([chunk, place])),
          iconButton("copy", "Copy this line", () =>
            copyAndTell(`${textOf(line)}${line.place ? ` (${line.place})` : ""}`),
          ),
          iconButton("close", "Close", () => set(detail, { hidden: true })),
        ),
        el("div", { class: "wv-quiet" }, timeOfDay(line.stamp, true)),
        el("pre", {}, line.text),
        el("div", { class: "wv-quiet" }, line.place || "No file and line."),
      );
      set(detail, { hidden: false });
      mark(false);
    }

    /** @param {boolean} now */
    function mark(now) {
      isFollowing = now;
      set(follow, { "aria-pressed": String(now) });
    }

    /** @param {boolean} now */
    function setFollowing(now) {
      mark(now);
      toEnd();
    }

    function filter() {
      filtered = new WeakMap();
      draw();
    }

    function draw() {
      shown = collect();
      list.show(shown);
      const number = shown.length.toLocaleString("en").replaceAll(",", " ");
      setText(count, `${number} line${shown.length === 1 ? "" : "s"}`);
      const sentence =
        problem || (shown.length ? "" : total ? "No line matches these filters." : "No line yet.");
      showText(empty, sentence);
      toEnd();
      requestAnimationFrame(toEnd); // the list may have no height yet
    }

    /**
     * The lines of a chunk that the filters leave.
     *
     * @param {Chunk} chunk
     * @param {number} number
     */
    function linesOf(chunk, number) {
      const known = filtered.get(chunk);
      if (known) return known;
      const least = (LEVELS.indexOf(level.value) + 1) * 10;
      const [node, part] = [nodes.value.toLowerCase(), text.value.toLowerCase()];
      /** @type {Line[]} */
      const found = [];
      chunk.levels.forEach((each, i) => {
        if (each < least) return;
        if (node && !chunk.names[i].toLowerCase().includes(node)) return;
        if (part && !chunk.texts[i].toLowerCase().includes(part)) return;
        found.push({
          key: `${number}/${i}`,
          stamp: chunk.stamps[i],
          level: each,
          name: chunk.names[i],
          text: chunk.texts[i],
          place: chunk.places[i],
        });
      });
      filtered.set(chunk, found);
      return found;
    }

    /**
     * @param {Values} values
     * @param {(key: string) => Chunk | undefined} part
     */
    function update(values, part) {
      const own = { level: values.level, nodes: values.nodes, text: values.text };
      if (own.level && JSON.stringify(own) !== JSON.stringify(initial)) {
        initial = own;
        [level.value, nodes.value, text.value] = [own.level, own.nodes, own.text];
        filtered = new WeakMap();
      }
      const [first, end] = values.chunks ?? [0, 0];
      collect = () => {
        const found = [];
        for (let number = first; number < end; number++) {
          const chunk = part(String(number));
          if (chunk) found.push(linesOf(chunk, number));
        }
        return found.flat();
      };
      problem = values.problem ?? "";
      total = values.total ?? 0;
      if (values.beginnings !== beginnings) mark(true); // those of another time
      beginnings = values.beginnings;
      draw();
    }

    mark(true);
    const element = el("div", { class: "wv-plugin-fill" }, empty, list.element, detail);
    function close() {
      sizes.disconnect();
      list.close();
    }
    const head = el(
      "span",
      { class: "wv-panel-tools" },
      ...[lowest.element, nodes, text, count, follow, all],
    );
    return { element, head, update, close };
  });
}
