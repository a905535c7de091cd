// The table of topics: which there are, in which order, and their cells.

import { dragField } from "webviz/panels/field_drag.js";
import { el } from "webviz/dom.js";
import { wordsOf } from "webviz/words.js";
import { bytesText, rateText, spanText } from "webviz/panels/units.js";

/** @import {GraphTopic, TopicTraffic} from "webviz/contents.js" */
/** @import {Signal} from "webviz/signals.js" */

/**
 * @typedef {{key: string} & GraphTopic & Partial<TopicTraffic>} TopicRow
 * @typedef {{column: string, isUp: boolean}} Sort
 * @typedef {string | number | null | undefined} Cell
 * @typedef {{
 *   id: string, title: string, hint?: string, isNumber?: boolean,
 *   value: (topic: TopicRow) => Cell, text: (topic: TopicRow) => string,
 * }} Column
 */

const LATCHED = "transient local";

/** @param {string} type */
const shortType = (type) => type.replace("/msg/", "/");
/**
 * @param {number | null} count
 * @param {string} word
 */
const amountOf = (count, word) =>
  count === null ? "" : `${count} ${word}${count === 1 ? "" : "s"}`;

/**
 * The columns: `value` is what they are sorted by, those of numbers from the largest.
 *
 * @type {Column[]}
 */
const COLUMNS = [
  { id: "name", title: "Name", value: (topic) => topic.key, text: (topic) => topic.key },
  { id: "type", title: "Type", value: (topic) => topic.types[0] ?? "", text: typesText },
  {
    id: "publishers",
    title: "Pubs",
    hint: "Publishers",
    isNumber: true,
    value: (topic) => topic.nodes.length,
    text: (topic) => amountOf(topic.nodes.length, "pub"),
  },
  {
    id: "subscribers",
    title: "Subs",
    hint: "Subscribers, this viewer included",
    isNumber: true,
    value: (topic) => topic.subscribers,
    text: (topic) => amountOf(topic.subscribers, "sub"),
  },
  { id: "qos", title: "QoS", value: (topic) => topic.qos, text: (topic) => topic.qos },
  {
    id: "rate",
    title: "Rate",
    hint: "Messages per second (subscribed topics only)",
    isNumber: true,
    value: (topic) => topic.hz,
    text: ({ hz, qos }) => (hz === 0 && qos.endsWith(LATCHED) ? "latched" : rateText(hz)),
  },
  {
    id: "bytes",
    title: "Bandwidth",
    isNumber: true,
    value: (topic) => topic.bytes,
    text: (topic) => bytesText(topic.bytes),
  },
  {
    id: "delay",
    title: "Delay",
    hint: "From the stamp of a message to its arrival",
    isNumber: true,
    value: (topic) => topic.delay,
    text: (topic) => spanText(topic.delay),
  },
];

/** @param {TopicRow} topic */
function typesText(topic) {
  return topic.types.length ? topic.types.map(shortType).join(", ") : "no publisher";
}

/**
 * The topics with every word of a text in name or type, in the order of a column.
 *
 * @param {TopicRow[]} topics
 * @param {string} text
 * @param {Sort} sort
 */
export function arranged(topics, text, sort) {
  const words = wordsOf(text);
  const matches = topics.filter(({ key, types }) => {
    const all = `${key} ${types.join(" ")}`.toLowerCase();
    return words.every((word) => all.includes(word));
  });
  const { value, isNumber } = COLUMNS.find(({ id }) => id === sort.column) ?? COLUMNS[0];
  const sign = sort.isUp ? 1 : -1;
  return matches.sort(
    (a, b) => sign * compare(value(a), value(b), isNumber) || compare(a.key, b.key),
  );
}

/**
 * @param {Cell} a
 * @param {Cell} b
 * @param {boolean} [isNumber]
 * @returns {number}
 */
function compare(a, b, isNumber = false) {
  if (isNumber) return Number(a ?? -1) - Number(b ?? -1);
  const [first, second] = [String(a), String(b)];
  return first < second ? -1 : Number(first > second);
}

/** @type {Record<string, (topic: TopicRow) => string>} */
const TIPS = {
  name: ({ key }) => key,
  type: ({ types }) => types.join("\n"),
  publishers: ({ nodes }) => nodes.slice(0, 20).join("\n"),
};

/** @param {() => TopicRow} topic read in effects */
export function topicRow(topic) {
  const element = el(
    "div",
    { class: "wv-topic", "data-silent": () => topic().types.length === 0 },
    COLUMNS.map(({ id, isNumber, text }) =>
      el(
        "span",
        {
          class: `wv-ellipsis wv-cell-${id}${isNumber ? " wv-number" : ""}`,
          role: "gridcell",
          "data-tip": Object.hasOwn(TIPS, id) ? () => TIPS[id](topic()) : null,
        },
        () => text(topic()),
      ),
    ),
  );
  dragField(element, () => ({ topic: topic().key, path: "" }));
  return element;
}

/**
 * The heads of the columns; a click sorts by one, numbers from the largest.
 *
 * @param {Signal<Sort>} sort
 */
export function tableHead(sort) {
  /** @param {Column} column */
  const choose = ({ id, isNumber = false }) => {
    const { column, isUp } = sort.value;
    sort.value = { column: id, isUp: column === id ? !isUp : !isNumber };
  };
  /** @param {string} id */
  const order = (id) =>
    id !== sort.value.column ? "none" : sort.value.isUp ? "ascending" : "descending";
  return el(
    "div",
    { class: "wv-topics-head", role: "row" },
    COLUMNS.map((column) => {
      const { id, title, hint = title } = column;
      const attributes = { type: "button", class: `wv-cell-${id}`, title: hint };
      return el(
        "span",
        { role: "columnheader", class: `wv-head-${id}`, "aria-sort": () => order(id) },
        el("button", { ...attributes, onclick: () => choose(column) }, title),
      );
    }),
  );
}
