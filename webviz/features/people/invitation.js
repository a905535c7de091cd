// A form that makes a link for another person, and shows it with its QR code.

import { act } from "webviz/act.js";
import { combobox } from "webviz/controls/combobox.js";
import { textField } from "webviz/controls/fields.js";
import { el, setText } from "webviz/dom.js";
import { textButton } from "webviz/icons.js";
import { signal } from "webviz/signals.js";

/** @import {Commands} from "webviz/messages.js" */

/** @type {[string, number | null][]} */
const ENDS = [
  ["never ends", null],
  ["ends in 1 day", 1],
  ["ends in 7 days", 7],
  ["ends in 30 days", 30],
];

const LOCAL =
  "Only this machine can open this link. For others, start webviz with --host, open this page " +
  "under the address that they use, and invite them there.";

const isOfThisMachine = () => /^(localhost|127\..*|\[::1\])$/.test(location.hostname);

/**
 * The form; `copy(link)` is called to copy the link.
 *
 * @param {(link: string) => unknown} copy
 */
export function invitation(copy) {
  const name = textField("Name", { placeholder: "Name", maxlength: 40 });
  const [role, roleField] = oneOf("Role", ["watcher", "operator", "owner"]);
  const [end, endField] = oneOf(
    "End",
    ENDS.map(([label]) => label),
  );
  const make = textButton("Make a link", invite);
  const problem = el("p", { class: "wv-problem", role: "alert" });
  const result = el("div", { class: "wv-invitation", hidden: true });
  name.addEventListener("keydown", (event) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    invite();
  });

  async function invite() {
    setText(problem, "");
    const { level, text, link, code } = await act(
      "Invite",
      {
        name: name.value.trim(),
        role: /** @type {Commands["Invite"]["role"]} */ (role.value),
        days: ENDS.find(([label]) => label === end.value)?.[1] ?? null,
        url: location.origin + location.pathname,
      },
      { quiet: true, errors: "caller" },
    );
    const isRefused = level === "error";
    setText(problem, isRefused ? text : "");
    result.hidden = isRefused;
    if (isRefused) return;
    result.replaceChildren(
      el("img", { src: code, alt: "QR code of the link" }),
      el(
        "div",
        {},
        el("p", {}, el("code", {}, link)),
        isOfThisMachine() ? el("p", { role: "note" }, LOCAL) : null,
        textButton("Copy", () => copy(link)),
      ),
    );
    name.value = "";
  }

  return el(
    "div",
    {},
    el("div", { class: "wv-invite" }, name, roleField, endField, make),
    problem,
    result,
  );
}

/**
 * The chosen one of some texts, the first at first, and its field.
 *
 * @param {string} label
 * @param {string[]} texts
 */
function oneOf(label, texts) {
  const chosen = signal(texts[0]);
  const { element } = combobox({
    label,
    value: () => chosen.value,
    options: () => texts.map((value) => ({ value })),
    change: (text) => (chosen.value = text),
    free: false,
  });
  return /** @type {const} */ ([chosen, element]);
}
