// Who is connected and what they did, and how the owner invites others.

import { onRole, self, why } from "../access.js";
import { copy } from "../clipboard.js";
import { el } from "../dom.js";
import { watch } from "../stores.js";
import { openDialog } from "./dialog.js";
import { invitation } from "./invitation.js";
import { toast } from "./toasts.js";

/** A word on the role of this page, for those who are not the owner. */
export function roleMark() {
  const mark = el("span", { class: "wv-role", hidden: true });
  onRole(() => {
    const { role, name } = self();
    mark.hidden = role === "owner";
    mark.textContent = role;
    mark.dataset.tip = `Your link${name ? `, ${name},` : ""} is for ${role === "operator" ? "an" : "a"} ${role}.`;
  });
  return mark;
}

export async function openPeople() {
  const isOwner = self().role === "owner";
  const known = { people: new Map(), addresses: new Map(), journal: new Map() };
  const here = el("tbody");
  const done = el("tbody");
  const show = () => {
    here.replaceChildren(...[...known.people].map((entry) => personRow(entry, known.addresses, isOwner)));
    done.replaceChildren(...(known.journal.get("entries") ?? []).map(entryRow));
  };
  const stores = isOwner ? ["people", "addresses", "journal"] : ["people"];
  const ends = stores.map((name) => watch(name, (values) => {
    known[name] = values;
    show();
  }));
  const columns = ["Name", "Role", ...(isOwner ? ["Address"] : []), "Since", "Latency", "Drives"];
  await openDialog({
    title: "People",
    className: "wv-people",
    isLight: true,
    content: [
      table("Connected", columns, here),
      ...(isOwner ? [
        el("h3", {}, "Invite"), invitation(tell),
        el("h3", {}, "Log"),
        el("div", { class: "wv-people-log" }, table("Log", ["Time", "Who", "What"], done)),
      ] : [el("p", { class: "wv-quiet" }, why("Invite"))]),
    ],
  });
  ends.forEach((end) => end());
}

async function tell(link) {
  const isDone = await copy(link);
  toast(isDone ? "Copied the link." : "This browser does not allow copying.", {
    level: isDone ? "ok" : "error",
  });
}

const table = (label, columns, body) =>
  el("table", { "aria-label": label },
    el("thead", {}, el("tr", {}, columns.map((name) => el("th", {}, name)))), body);

const cells = (...texts) => el("tr", {}, texts.map((text) => el("td", {}, text)));

function personRow([id, person], addresses, isOwner) {
  const isYou = id === String(window.webviz.browser);
  const name = [person.name || "no link needed", isYou && "(you)"].filter(Boolean).join(" ");
  return cells(
    name, person.role, ...(isOwner ? [addresses.get(id) ?? ""] : []), timeOf(person.since_s),
    person.latency_ms === null ? "not measured yet" : `${person.latency_ms} ms`,
    person.drives.join(", "),
  );
}

const entryRow = ({ time_s, name, role, address, text }) =>
  cells(timeOf(time_s), [name, role, address].filter(Boolean).join(", "), text);

const timeOf = (seconds) => new Date(seconds * 1000).toLocaleTimeString();
