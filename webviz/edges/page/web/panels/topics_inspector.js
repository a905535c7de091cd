// One topic: who publishes it and how, its last message as a tree, and a display for it.

import { act } from "../act.js";
import { copy } from "../clipboard.js";
import { wallNow } from "../clock.js";
import { indent, rowList, touchable } from "../controls/rows.js";
import { el, set, setText } from "../dom.js";
import { icon } from "../icons.js";
import { openMenuBelow } from "../shell/menu.js";
import { toast } from "../shell/toasts.js";
import { watch } from "../stores.js";
import { rowsOf, textOf } from "./message_tree.js";
import { bytesText, rateText, sizeText, spanText } from "./units.js";

const ROW_PX = 22;
const OLD_S = 2; // until then, an age says nothing that the rate does not say

/** Fills `place` with the topic of this name until it is closed; returns `{name, update, close}`. */
export function inspector(place, name, dismiss) {
  const folds = new Map();
  let message = null;
  let fits = [];
  let receivedAt = 0;
  let size = 0;

  const button = (label, iconName, onclick) =>
    el("button", { type: "button", class: "wv-icon", title: label, "aria-label": label, onclick },
      icon(iconName));
  const show = el("button", { type: "button", class: "wv-button", onclick: add }, icon("plus"), "Show");
  const copyMessage = button("Copy message", "file", () => copied(textOf(message)));
  const facts = el("div", { class: "wv-topic-facts wv-quiet" });
  const why = el("div", { class: "wv-topic-why wv-quiet", hidden: true });
  const age = el("div", { class: "wv-topic-age wv-quiet wv-number" });
  const problem = el("div", { class: "wv-empty", role: "status", hidden: true });
  const tree = rowList({
    label: `Last message on ${name}`, role: "tree", rowRole: "treeitem", height: touchable(ROW_PX),
    make: makeRow, update: updateRow, choose: toggle, onKey,
  });
  place.replaceChildren(el("section", { class: "wv-inspected", "aria-label": name },
    el("header", {},
      el("h3", { class: "wv-ellipsis", title: name }, name),
      show, button("Copy name", "copy", () => copied(name)), copyMessage,
      button("Close", "close", dismiss)),
    facts, why, age, problem, tree.element));

  async function copied(text) {
    const isDone = await copy(text);
    toast(isDone ? "Copied." : "This browser does not allow copying.", { level: isDone ? "ok" : "error" });
  }

  async function add() {
    const one = async ([type, input]) => {
      const { level } = await act("AddDisplay", { type, values: { [input]: name } });
      if (level === "ok") toast(`Added ${type} for ${name}.`);
    };
    if (fits.length === 1) return one(fits[0]);
    openMenuBelow(show, fits.map((fit) => ({ label: fit[0], icon: "plus", run: () => one(fit) })));
  }

  function update(topic) {
    fits = topic?.show ?? [];
    set(show, { disabled: fits.length === 0, "data-tip": fits.length ? "Add a display" : topic?.why });
    setText(why, topic?.why ?? "");
    set(why, { hidden: !topic?.why });
    const texts = topic
      ? [topic.types.join(", "), [...new Set(topic.nodes)].slice(0, 5).join(", "), topic.qos, rateText(topic.hz),
        bytesText(topic.bytes), topic.delay === undefined ? "" : `delay ${spanText(topic.delay)}`]
      : [];
    setText(facts, texts.filter(Boolean).join(" · "));
  }

  function showMessage(values) {
    message = values.get("message") ?? null;
    receivedAt = values.get("received") ?? 0;
    size = values.get("size") ?? 0;
    const sentence = values.get("problem") ?? "";
    setText(problem, sentence);
    set(problem, { hidden: !sentence });
    set(copyMessage, { disabled: !message });
    showRows();
    showAge();
  }

  function showRows() {
    tree.show(message ? rowsOf(message, folds) : []);
  }

  function showAge() {
    const old = wallNow() - receivedAt;
    const texts = receivedAt ? [sizeText(size), old > OLD_S ? `${spanText(old)} ago` : ""] : [];
    setText(age, texts.length ? `Last message: ${texts.filter(Boolean).join(", ")}` : "");
  }

  function toggle(row) {
    if (row.isOpen === null) return;
    folds.set(row.key, !row.isOpen);
    showRows();
  }

  function onKey({ key }, row) {
    const isFold = (key === "ArrowLeft" && row.isOpen) || (key === "ArrowRight" && row.isOpen === false);
    if (isFold) toggle(row);
    else if (key === "ArrowLeft" && row.depth) tree.mark(row.key.slice(0, row.key.lastIndexOf("/")));
    return isFold || key === "ArrowLeft";
  }

  const timer = setInterval(showAge, 1000);
  const end = watch(`message:${name}`, showMessage);
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

function makeRow() {
  return el("div", { class: "wv-field-row" },
    el("span", { class: "wv-fold-mark" }, icon("chevron", 12)),
    el("span", { class: "wv-field-name" }), el("span", { class: "wv-field-value wv-ellipsis" }));
}

function updateRow(element, row) {
  const [fold, name, value] = element.children;
  set(fold, { "data-open": row.isOpen ? "" : null, "data-none": row.isOpen === null ? "" : null });
  setText(name, row.name);
  setText(value, row.value);
  set(value, { "data-tip": row.value.length > 30 ? row.value : null });
  set(element, {
    "aria-level": row.depth + 1,
    "aria-expanded": row.isOpen === null ? null : String(row.isOpen),
  });
  indent(element, row.depth);
}
