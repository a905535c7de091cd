// Statuses of a display, or of the viewer: a line each, folded to the worst.

import { needs } from "../../access.js";
import { act } from "../../act.js";
import { el, set, setChildren, setText } from "../../dom.js";
import { icon } from "../../icons.js";

let count = 0;

/** A button that does what helps. */
export const remedyButton = ({ label, command, arguments: fields }) =>
  needs(
    command,
    el(
      "button",
      {
        type: "button",
        class: "wv-button wv-remedy",
        onclick: () => act(command, fields),
      },
      label,
    ),
  );

/**
 * Statuses that are folded while all is well, until they are unfolded by hand.
 *
 * `open(listener)` is called while they are unfolded, and returns what ends that; the listener gets
 * `lines`: `[key, level, text, remedy]`, and how many `more` there are; a remedy is
 * `{label, command, arguments}`, what a click can do about it. Returns `{element, worst(line), end()}`.
 */
export function statuses({ open }) {
  count += 1;
  const list = el("ul", { class: "wv-statuses-lines", id: `wv-statuses-${count}` });
  const note = el("span", { class: "wv-status-note" });
  const toggle = el(
    "button",
    {
      type: "button",
      class: "wv-section-fold wv-status-head",
      "aria-controls": list.id,
      onclick: () => {
        chosen = list.hidden;
        unfold();
      },
    },
    icon("chevron", 12),
    "Status",
    el("span", { class: "wv-dot", "aria-hidden": "true" }),
    note,
  );
  const element = el("section", { class: "wv-statuses", "aria-label": "Status" }, toggle, list);
  let chosen = null;
  let level = "ok";
  let close = null;

  function unfold() {
    const isOpen = chosen ?? level !== "ok";
    if (isOpen === Boolean(close)) return;
    list.hidden = !isOpen;
    set(toggle, { "aria-expanded": String(isOpen) });
    close?.();
    close = isOpen ? open(show) : null;
  }

  function show(lines, more) {
    const items = lines.map((line, index) => fill(list.children[index] ?? item(), line));
    const rest = more ? [el("li", { class: "wv-quiet" }, `and ${more} more`)] : [];
    setChildren(list, [...items, ...rest]);
  }

  function fill(element, [key, own, text, remedy]) {
    const [name, said] = element.children;
    set(element, { "data-level": own });
    setText(name, `${key}: `);
    setText(said, text);
    const isThere = element.children.length > 2;
    if (isThere && element.dataset.remedy !== JSON.stringify(remedy))
      element.lastElementChild.remove();
    if (remedy && element.children.length === 2) {
      set(element, { "data-remedy": JSON.stringify(remedy) });
      element.append(remedyButton(remedy));
    }
    return element;
  }

  const item = () => el("li", {}, el("b"), el("span"));

  set(toggle, { "aria-expanded": "false" });
  list.hidden = true;
  return {
    element,
    /** The worst line, null for none; it decides what is folded. */
    worst(line) {
      element.hidden = !line;
      level = line?.level ?? "ok";
      set(toggle, { "data-level": level });
      setText(note, level === "ok" ? "OK" : `${line.key}: ${line.text}`);
      unfold();
    },
    end: () => close?.(),
  };
}
