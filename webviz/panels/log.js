// The widget "log": the lines of a log, filtered in this page.

import { copyAndTell } from "webviz/clipboard.js";
import { combobox } from "webviz/controls/combobox.js";
import { searchField } from "webviz/controls/fields.js";
import { rowList, touchable } from "webviz/controls/rows.js";
import { el } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { batch, computed, effect, owned, signal, untracked } from "webviz/signals.js";
import { timeOfDay } from "webviz/time_text.js";

/** @import {Readable, Signal} from "../page/web/signals.js" */
/** @import {Page} from "../page/web/extensions.js" */

/**
 * @typedef {{
 *   stamps: number[], levels: number[], names: string[], texts: string[], places: string[],
 * }} Chunk
 * @typedef {{key: string, stamp: number, level: number, name: string, text: string, place: string}} Line
 * @typedef {{chunks: [number, number], problem: string, total: number, beginnings: number,
 *   level: string, nodes: string, text: string}} Values
 * @typedef {(chunk: Chunk, i: number) => boolean} Matches
 */

const LEVELS = ["Debug", "Info", "Warn", "Error", "Fatal"];
const ROW_PX = 20;
const TALL_PX = 36; // with the text below the rest
const NARROW_PX = 480;
/** @type {{values: Partial<Values>, part: (key: string) => Chunk | undefined}} */
const NOTHING = { values: {}, part: () => undefined };

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
  widget("log", (_, send) => log(send));
}

/** @param {(place: [number, number]) => unknown} send */
function log(send) {
  const latest = signal(NOTHING);
  const filter = filters();
  const linesOf = computed(() => linesBy(filter.matches()));
  const lines = computed(() => {
    const { values, part } = latest.value;
    const [first, end] = values.chunks ?? [0, 0];
    const numbers = Array.from({ length: end - first }, (_, i) => first + i);
    return numbers.flatMap((number) => {
      const chunk = part(String(number));
      return chunk ? linesOf.value(chunk, number) : [];
    });
  });
  const opened = signal(/** @type {Line | null} */ (null));
  const list = rowList({
    label: "Log",
    height: touchable(ROW_PX),
    row: rowOf,
    choose(line) {
      opened.value = line;
      isFollowing.value = false;
    },
  });
  const { isFollowing, toEnd } = follower(list.element);
  whenNarrow(list, toEnd);
  effect(() => {
    list.show(lines.value);
    toEnd();
    requestAnimationFrame(toEnd); // the list may have no height yet
  });
  const beginnings = computed(() => latest.value.values.beginnings);
  effect(() => {
    if (beginnings.value !== undefined) isFollowing.value = true; // those of another time
  });
  const sentence = () => {
    const { problem, total } = latest.value.values;
    if (problem || lines.value.length) return problem ?? "";
    return total ? "No line matches these filters." : "No line yet.";
  };
  return {
    element: el(
      "div",
      { class: "wv-plugin-fill" },
      el("div", { class: "wv-empty", role: "status", hidden: () => !sentence() }, sentence),
      list.element,
      detail(opened, send),
    ),
    head: el("span", { class: "wv-panel-tools" }, filter.fields, tools(lines, isFollowing, toEnd)),
    /**
     * @param {Values} values
     * @param {(key: string) => Chunk | undefined} part
     */
    update: (values, part) =>
      batch(() => {
        filter.begin(values);
        latest.value = { values, part };
      }),
  };
}

/**
 * The number of lines, and buttons for all of them.
 *
 * @param {Readable<Line[]>} lines
 * @param {Signal<boolean>} isFollowing
 * @param {() => void} toEnd
 */
function tools(lines, isFollowing, toEnd) {
  const count = () => {
    const number = lines.value.length;
    const text = number.toLocaleString("en").replaceAll(",", " ");
    return `${text} line${number === 1 ? "" : "s"}`;
  };
  const follow = () => {
    isFollowing.value = !isFollowing.value;
    toEnd();
  };
  const copy = () => copyAndTell(lines.value.map(textOf).join("\n"));
  return [
    el("span", { class: "wv-quiet wv-number" }, count),
    iconButton("follow", "Follow the newest line", follow, {
      "aria-pressed": () => String(isFollowing.value),
    }),
    iconButton("copy", "Copy the visible lines", copy),
  ];
}

/** @param {() => Line} line */
const rowOf = (line) =>
  el(
    "div",
    { class: "wv-log-row", "data-level": () => stateOf(line().level) },
    el("span", {}, () => nameOf(line().level)),
    el("span", { class: "wv-number" }, () => timeOfDay(line().stamp, true).split(" ").pop() ?? ""),
    el("span", { class: "wv-ellipsis" }, () => line().name),
    el("span", { class: "wv-ellipsis" }, () => line().text.split("\n", 1)[0]),
  );

/**
 * The fields of the filters; `matches()` is read in effects, and `begin(values)` takes filters of the
 * panel once they are others.
 */
function filters() {
  const level = signal(LEVELS[0]);
  const lowest = combobox({
    label: "Lowest level",
    value: () => level.value,
    options: () => LEVELS.map((value) => ({ value })),
    change: (value) => (level.value = value),
    free: false,
  });
  const [nodes, text] = [textFilter("Node"), textFilter("Text")];
  let initial = "";
  return {
    fields: [lowest.element, nodes.field, text.field],
    /** @returns {Matches} */
    matches() {
      const least = (LEVELS.indexOf(level.value) + 1) * 10;
      const [node, part] = [nodes.text.value.toLowerCase(), text.text.value.toLowerCase()];
      return ({ levels, names, texts }, i) =>
        levels[i] >= least &&
        names[i].toLowerCase().includes(node) &&
        texts[i].toLowerCase().includes(part);
    },
    /** @param {Values} values */
    begin(values) {
      const own = JSON.stringify([values.level, values.nodes, values.text]);
      if (!values.level || own === initial) return;
      initial = own;
      level.value = values.level;
      nodes.put(values.nodes);
      text.put(values.text);
    },
  };
}

/** @param {string} label */
function textFilter(label) {
  const text = signal("");
  /** @type {HTMLInputElement} */
  const field = searchField(label, () => (text.value = field.value));
  /** @param {string} value */
  const put = (value) => (text.value = field.value = value);
  return { field, text, put };
}

/**
 * A function of the lines of a chunk that match, which finds them once.
 *
 * @param {Matches} matches
 */
function linesBy(matches) {
  /** @type {WeakMap<Chunk, Line[]>} */
  const cache = new WeakMap();
  /**
   * @param {Chunk} chunk
   * @param {number} number
   */
  return (chunk, number) => {
    const lines = cache.get(chunk) ?? linesIn(chunk, number, matches);
    cache.set(chunk, lines);
    return lines;
  };
}

/**
 * @param {Chunk} chunk
 * @param {number} number
 * @param {Matches} matches
 */
const linesIn = (chunk, number, matches) =>
  chunk.levels.flatMap((level, i) => {
    if (!matches(chunk, i)) return [];
    const [stamp, name] = [chunk.stamps[i], chunk.names[i]];
    const [text, place] = [chunk.texts[i], chunk.places[i]];
    return [{ key: `${number}/${i}`, stamp, level, name, text, place }];
  });

/**
 * Keeps a list at its end until the user scrolls up, and again once they are back there.
 *
 * @param {HTMLElement} list
 */
function follower(list) {
  const isFollowing = signal(true);
  let top = 0;
  const toEnd = () => {
    if (!untracked(() => isFollowing.value)) return;
    list.scrollTop = list.scrollHeight;
    top = list.scrollTop; // the browser takes less
  };
  list.addEventListener("scroll", () => {
    const { scrollTop, scrollHeight, clientHeight } = list;
    const isUp = scrollTop < top;
    // A list that became shorter is scrolled up by the browser, which leaves it at its end.
    if (scrollHeight - scrollTop - clientHeight < (isUp ? 1 : ROW_PX)) isFollowing.value = true;
    else if (isUp) isFollowing.value = false;
    top = scrollTop;
  });
  return { isFollowing, toEnd };
}

/**
 * Gives rows the height of two lines where there is no room for one, and calls `resized` after that.
 *
 * @param {Pick<ReturnType<typeof rowList>, "element" | "resize">} list
 * @param {() => void} resized
 */
function whenNarrow({ element, resize }, resized) {
  const sizes = new ResizeObserver(() => {
    const isNarrow = element.clientWidth < NARROW_PX;
    (element.firstElementChild ?? element).toggleAttribute("data-narrow", isNarrow);
    resize(touchable(isNarrow ? TALL_PX : ROW_PX));
    resized();
  });
  sizes.observe(element);
  owned(() => sizes.disconnect());
}

/**
 * All that is known of one line.
 *
 * @param {Signal<Line | null>} opened
 * @param {(place: [number, number]) => unknown} send
 */
function detail(opened, send) {
  /** @param {Line} line */
  const parts = (line) => {
    const [chunk, place] = line.key.split("/").map(Number);
    const whole = `${textOf(line)}${line.place ? ` (${line.place})` : ""}`;
    return [
      el(
        "div",
        { class: "wv-plugin-bar" },
        el("b", { class: "wv-ellipsis" }, `${nameOf(line.level)} of ${line.name}`),
        iconButton("clock", "Go to this time", () => send([chunk, place])),
        iconButton("copy", "Copy this line", () => copyAndTell(whole)),
        iconButton("close", "Close", () => (opened.value = null)),
      ),
      el("div", { class: "wv-quiet" }, timeOfDay(line.stamp, true)),
      el("pre", {}, line.text),
      el("div", { class: "wv-quiet" }, line.place || "No file and line."),
    ];
  };
  return el("div", { class: "wv-plugin-detail wv-log-detail", hidden: () => !opened.value }, () =>
    opened.value ? parts(opened.value) : [],
  );
}
