// A form that makes a link for somebody else, and shows it with its QR code.

import * as channel from "../channel.js";
import { el, setText } from "../dom.js";

/** @type {[string, number | null][]} */
const ENDS = [["never ends", null], ["ends in 1 day", 1], ["ends in 7 days", 7], ["ends in 30 days", 30]];

const LOCAL = "Only this machine can open this link. For others, start webviz with --host, open this page "
  + "under the address that they use, and invite them there.";

const isOfThisMachine = () => /^(localhost|127\..*|\[::1\])$/.test(location.hostname);

const waiting = new Map();
let count = 0;

channel.on("Invitation", (made) => {
  waiting.get(made.number)?.(made);
  waiting.delete(made.number);
});

/** The form; `copy(link)` is called to copy the link. */
export function invitation(copy) {
  const name = el("input", {
    class: "wv-field", type: "text", "aria-label": "Name", placeholder: "Name", maxlength: 40,
  });
  const role = select("Role", ["watcher", "operator", "owner"]);
  const end = select("End", ENDS.map(([label]) => label));
  const make = el("button", { type: "button", class: "wv-button", onclick: invite }, "Make a link");
  const problem = el("p", { class: "wv-problem", role: "alert" });
  const result = el("div", { class: "wv-invitation", hidden: true });
  name.addEventListener("keydown", (event) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    invite();
  });

  function invite() {
    count += 1;
    waiting.set(count, show);
    setText(problem, "");
    channel.send({
      type: "Invite", number: count, name: name.value.trim(), role: role.value,
      days: ENDS[end.selectedIndex][1], url: location.origin + location.pathname,
    });
  }

  function show({ problem: reason, link, code }) {
    setText(problem, reason);
    result.hidden = reason !== "";
    if (reason) return;
    result.replaceChildren(
      el("img", { src: code, alt: "QR code of the link" }),
      el("div", {}, el("p", {}, el("code", {}, link)), isOfThisMachine() ? el("p", { role: "note" }, LOCAL) : null,
        el("button", { type: "button", class: "wv-button", onclick: () => copy(link) }, "Copy")),
    );
    name.value = "";
  }

  return el("div", {}, el("div", { class: "wv-invite" }, name, role, end, make), problem, result);
}

const select = (label, options) =>
  el("select", { class: "wv-field", "aria-label": label }, options.map((text) => el("option", {}, text)));
