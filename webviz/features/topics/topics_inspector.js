// One topic: who publishes it and how, its last message as a tree, and a display for it.

import { needs } from "../../access.js";
import { act } from "../../act.js";
import { copyAndTell } from "../../clipboard.js";
import { wallNow } from "../../clock.js";
import { el, set, setText, showText } from "../../dom.js";
import { iconButton, textButton } from "../../icons.js";
import { openMenuBelow } from "../../controls/menu.js";
import { toast } from "../../toasts.js";
import { watch } from "../../stores.js";
import { messageRows } from "../../panels/message_rows.js";
import { textOf } from "../../panels/message_tree.js";
import { bytesText, rateText, sizeText, spanText } from "../../panels/units.js";

/** @import {Fields} from "../../panels/message_tree.js" */
/** @import {GraphTopic} from "../../contents.js" */
/** @import {TopicRow} from "../../panels/topics_table.js" */
/** @import {ValuesOf} from "../../types.js" */

const OLD_S = 2; // until then, an age says nothing that the rate does not say

/**
 * Fills `place` with the topic of this name until it is closed; returns `{name, update, close}`.
 *
 * @param {HTMLElement} place
 * @param {string} name
 * @param {() => void} dismiss
 */
export function inspector(place, name, dismiss) {
  /** @type {Fields | null} */
  let message = null;
  /** @type {GraphTopic["show"]} */
  let fits = [];
  let receivedAt = 0;
  let size = 0;

  const show = textButton("Show", add, { icon: "plus" });
  needs("AddDisplay", show);
  const copyMessage = iconButton(
    "file",
    "Copy message",
    () => message && copyAndTell(textOf(message)),
  );
  const facts = el("div", { class: "wv-topic-facts wv-quiet" });
  const why = el("div", { class: "wv-topic-why wv-quiet", hidden: true });
  const age = el("div", { class: "wv-topic-age wv-quiet wv-number" });
  const problem = el("div", { class: "wv-empty", role: "status", hidden: true });
  const tree = messageRows({ label: `Last message on ${name}`, topic: () => name });
  place.replaceChildren(
    el(
      "section",
      { class: "wv-inspected", "aria-label": name },
      el(
        "header",
        {},
        el("h3", { class: "wv-ellipsis", title: name }, name),
        show,
        iconButton("copy", "Copy name", () => copyAndTell(name)),
        copyMessage,
        iconButton("close", "Close", dismiss),
      ),
      facts,
      why,
      age,
      problem,
      tree.element,
    ),
  );

  async function add() {
    /** @param {GraphTopic["show"][number]} fit */
    const one = async ([type, values]) => {
      const { level } = await act("AddDisplay", { type, values });
      if (level === "ok") toast(`Added ${type} for ${name}.`);
    };
    if (fits.length === 1) return one(fits[0]);
    openMenuBelow(
      show,
      fits.map((fit) => ({ label: fit[0], icon: "plus", run: () => one(fit) })),
    );
  }

  /** @param {TopicRow | undefined} topic */
  function update(topic) {
    fits = topic?.show ?? [];
    set(show, {
      disabled: fits.length === 0,
      "data-tip": fits.length ? "Add a display" : topic?.why,
    });
    showText(why, topic?.why ?? "");
    const texts = topic
      ? [
          topic.types.join(", "),
          [...new Set(topic.nodes)].slice(0, 5).join(", "),
          topic.qos,
          rateText(topic.hz),
          bytesText(topic.bytes),
          topic.delay === undefined ? "" : `delay ${spanText(topic.delay)}`,
        ]
      : [];
    setText(facts, texts.filter(Boolean).join(" · "));
  }

  /** @param {ValuesOf<"message">} values */
  function showMessage(values) {
    message = /** @type {Fields | null} */ (values.get("message") ?? null);
    receivedAt = values.get("received") ?? 0;
    size = values.get("size") ?? 0;
    const sentence = values.get("problem") ?? "";
    showText(problem, sentence);
    set(copyMessage, { disabled: !message });
    tree.show(message);
    showAge();
  }

  function showAge() {
    const old = wallNow() - receivedAt;
    const texts = receivedAt ? [sizeText(size), old > OLD_S ? `${spanText(old)} ago` : ""] : [];
    setText(age, texts.length ? `Last message: ${texts.filter(Boolean).join(", ")}` : "");
  }

  const timer = setInterval(showAge, 1000);
  const end = watch(`message:${name}`, (values) => showMessage(values));
  return {
    name,
    update,
    close() {
      clearInterval(timer);
      end();
      tree.close();
      place.replaceChildren();
    },
  };
}
