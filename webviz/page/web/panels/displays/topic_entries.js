// Topics that can be added: each with the displays that show it, an image once for all transports.

import { isHiddenTopic } from "webviz/words.js";

/** @import {DisplayType, GraphTopic, TopicTraffic} from "webviz/contents.js" */
/** @import {OptionRow} from "webviz/controls/option_list.js" */
/** @import {ValuesOf} from "webviz/types.js" */

/**
 * @typedef {{type: string, values: Record<string, unknown>}} Choice
 * @typedef {OptionRow & {id: string, pick?: Choice}} AddRow
 * @typedef {{words: [title: string, more: string], rows: AddRow[]}} Entry
 * @typedef {{
 *   types: [string, DisplayType][] | null, topics: [string, GraphTopic][] | null,
 *   traffic: ValuesOf<"traffic"> | null, displayedTopics: Set<string> | null,
 * }} StoreContents
 * @typedef {{topic: string, offer: GraphTopic, transport: string}[]} Family
 */

const ANY = "any type";
const TRANSPORT = /^(.+)\/(compressed|compressedDepth|ffmpeg|theora|zstd|draco)$/; // of ROS's transports

/**
 * Entries `{words: [title, more], rows}` for `optionList`, those first that are not shown yet.
 *
 * `types`, `topics` and `traffic` are the stores; `shown` has the topics of all displays, `checked`
 * the ids of rows.
 *
 * @param {StoreContents} stores
 * @param {Map<string, Choice>} checked
 * @returns {Entry[]}
 */
export function topicEntries({ types, topics, traffic, displayedTopics }, checked) {
  /** @type {Map<string, string>} */
  const icons = new Map((types ?? []).map(([name, { icon }]) => [name, icon]));
  /** @type {Set<string>} */
  const plain = new Set(
    (types ?? []).filter(([, { topics }]) => topics.includes(ANY)).map(([name]) => name),
  );
  const entries = families(topics ?? []).map((family) => {
    const show = family.flatMap(({ offer }) => offer.show);
    const isShown = family.some(({ topic }) => displayedTopics?.has(topic));
    const isPlain = show.every(([display]) => plain.has(display));
    const isHidden = family.every(({ topic }) => isHiddenTopic(topic));
    const rank = !show.length ? 5 : isHidden ? 4 : Number(isShown) + 2 * Number(isPlain);
    return { rank, ...entryOf(family, { traffic, icons, isShown, isPlain, checked }) };
  });
  return entries.toSorted((a, b) => a.rank - b.rank);
}

/**
 * Topics in lists: an image with its transports that a display shows, every other one alone.
 *
 * @param {[string, GraphTopic][]} topics
 * @returns {Family[]}
 */
function families(topics) {
  const offers = new Map(topics);
  /** @type {Map<string, Family>} */
  const groups = new Map();
  for (const [topic, offer] of topics) {
    const [, base, transport] = TRANSPORT.exec(topic) ?? [];
    const isPart = offer.show.length && offers.get(base)?.show.length;
    const family = isPart ? base : topic;
    groups.set(family, [
      ...(groups.get(family) ?? []),
      { topic, offer, transport: isPart ? transport : "raw" },
    ]);
  }
  return [...groups.values()];
}

/**
 * @param {Family} family
 * @param {{
 *   traffic: StoreContents["traffic"], icons: Map<string, string>, isShown: boolean, isPlain: boolean,
 *   checked: Map<string, Choice>,
 * }} about
 * @returns {Entry}
 */
function entryOf(family, { traffic, icons, isShown, isPlain, checked }) {
  const [{ topic, offer }] = family;
  const note = noteOf(offer, traffic?.get(topic), isShown);
  if (!offer.show.length) {
    const row = { id: topic, icon: "file", title: topic, note, line: offer.why, disabled: true };
    return {
      words: [topic, offer.why],
      rows: [{ ...row, group: { title: "Not shown by any display" } }],
    };
  }
  const types = offer.types.join(", ");
  const rows = family.flatMap((member) =>
    member.offer.show.map(([display, values]) => ({
      id: `${member.topic} ${display}`,
      icon: icons.get(display),
      title: display,
      label: `${member.topic} ${display}`,
      note: family.length > 1 ? member.transport : undefined,
      group: { title: topic, line: types, note },
      isWithin: true,
      checked: checked.has(`${member.topic} ${display}`),
      pick: { type: display, values },
    })),
  );
  /** @type {Entry["words"]} */
  const words = [topic, rows.map(({ title, note }) => `${title} ${note}`).join(" ") + types];
  if (rows.length > 1)
    return {
      words,
      rows: rows.toSorted((a, b) => (a.title < b.title ? -1 : Number(a.title > b.title))),
    };
  const group = isPlain ? { title: "Shown as text only" } : undefined;
  const line = `${rows[0].title} · ${types}`;
  return { words, rows: [{ ...rows[0], title: topic, line, note, group, isWithin: false }] };
}

/**
 * @param {GraphTopic} offer
 * @param {TopicTraffic | undefined} traffic
 * @param {boolean} isShown
 */
function noteOf({ nodes }, traffic, isShown) {
  const rate = traffic?.hz ? `${Number(traffic.hz.toPrecision(2))} Hz` : "";
  const publishers = `${nodes.length} publisher${nodes.length === 1 ? "" : "s"}`;
  return [isShown ? "already shown" : "", rate, publishers].filter(Boolean).join(" · ");
}
