// One topic: who publishes it and how, its last message as a tree, and a display for it.

import { needs } from "webviz/access.js";
import { act } from "webviz/act.js";
import { copyAndTell } from "webviz/clipboard.js";
import { wallNow } from "webviz/clock.js";
import { el, set } from "webviz/dom.js";
import { iconButton, textButton } from "webviz/icons.js";
import { openMenuBelow } from "webviz/controls/menu.js";
import { toast } from "webviz/toasts.js";
import { effect, owned, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { messageRows } from "webviz/panels/message_rows.js";
import { textOf } from "webviz/panels/message_tree.js";
import { bytesText, rateText, sizeText, spanText } from "webviz/panels/units.js";

/** @import {MenuItem} from "webviz/controls/menu.js" */
/** @import {Fields} from "webviz/panels/message_tree.js" */
/** @import {GraphTopic} from "webviz/contents.js" */
/** @import {TopicRow} from "webviz/panels/topics_table.js" */

const OLD_S = 2; // until then, an age says nothing that the rate does not say

/**
 * All that is known of a topic, which is read by `topic()`.
 *
 * @param {string} name
 * @param {() => TopicRow | undefined} topic
 * @param {() => void} dismiss
 */
export function inspector(name, topic, dismiss) {
  const values = store(`message:${name}`);
  const message = () => /** @type {Fields | null} */ (values.get("message") ?? null);
  const problem = () => values.get("problem") ?? "";
  const why = () => topic()?.why ?? "";
  const fits = () => topic()?.show ?? [];
  const now = signal(wallNow());
  const timer = setInterval(() => (now.value = wallNow()), 1000);
  owned(() => clearInterval(timer));
  const tree = messageRows({ label: `Last message on ${name}`, topic: () => name });
  effect(() => tree.show(message()));
  /** @type {HTMLButtonElement} */
  const show = textButton(
    "Show",
    () => addDisplay(name, fits(), (items) => openMenuBelow(show, items)),
    {
      icon: "plus",
      disabled: () => fits().length === 0,
    },
  );
  set(show, { "data-tip": () => (fits().length ? "Add a display" : why()) });
  const copy = () => copyAndTell(textOf(/** @type {Fields} */ (message())));
  return el(
    "section",
    { class: "wv-inspected", "aria-label": name },
    el(
      "header",
      {},
      el("h3", { class: "wv-ellipsis", title: name }, name),
      needs("AddDisplay", show),
      iconButton("copy", "Copy name", () => copyAndTell(name)),
      iconButton("file", "Copy message", copy, { disabled: () => !message() }),
      iconButton("close", "Close", dismiss),
    ),
    el("div", { class: "wv-topic-facts wv-quiet" }, () => factsOf(topic())),
    el("div", { class: "wv-topic-why wv-quiet", hidden: () => !why() }, why),
    el("div", { class: "wv-topic-age wv-quiet wv-number" }, () =>
      ageOf(now.value, values.get("received") ?? 0, values.get("size") ?? 0),
    ),
    el("div", { class: "wv-empty", role: "status", hidden: () => !problem() }, problem),
    tree.element,
  );
}

/**
 * Adds a display for a topic, chosen if several fit from a menu that `open` opens.
 *
 * @param {string} name
 * @param {GraphTopic["show"]} fits
 * @param {(items: MenuItem[]) => unknown} open
 */
export function addDisplay(name, fits, open) {
  /** @param {GraphTopic["show"][number]} fit */
  const one = async ([type, values]) => {
    const { level } = await act("AddDisplay", { type, values });
    if (level === "ok") toast(`Added ${type} for ${name}.`);
  };
  if (fits.length === 1) return one(fits[0]);
  open(fits.map((fit) => ({ label: fit[0], icon: "plus", run: () => one(fit) })));
}

/** @param {TopicRow | undefined} topic */
function factsOf(topic) {
  if (!topic) return "";
  const texts = [
    topic.types.join(", "),
    [...new Set(topic.nodes)].slice(0, 5).join(", "),
    topic.qos,
    rateText(topic.hz),
    bytesText(topic.bytes),
    topic.delay === undefined ? "" : `delay ${spanText(topic.delay)}`,
  ];
  return texts.filter(Boolean).join(" · ");
}

/**
 * @param {number} now
 * @param {number} receivedAt
 * @param {number} size
 */
function ageOf(now, receivedAt, size) {
  if (!receivedAt) return "";
  const old = now - receivedAt;
  const texts = [sizeText(size), old > OLD_S ? `${spanText(old)} ago` : ""];
  return `Last message: ${texts.filter(Boolean).join(", ")}`;
}
