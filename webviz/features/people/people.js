// People who are connected, what they did, and invitations of the owner.

import { timeOfDay } from "webviz/time_text.js";
import { self, why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { copyAndTell } from "webviz/clipboard.js";
import { el } from "webviz/dom.js";
import { textButton } from "webviz/icons.js";
import { each, root } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { ask, openDialog } from "webviz/controls/dialog.js";
import { action } from "webviz/shell/actions.js";
import { invitation } from "webviz/features/people/invitation.js";

/** @import {JournalEntry, Person, ValidLink} from "webviz/contents.js" */
/** @import {Child} from "webviz/types.js" */

export const install = () =>
  action({ name: "People…", icon: "eye", group: "View", order: 0, run: openPeople });

const openPeople = () =>
  root(async (end) => {
    const isOwner = self().role === "owner";
    const columns = ["Name", "Role", "Address", "Since", "Latency", "Drives", ""];
    const headings = isOwner ? columns : columns.filter((name) => name && name !== "Address");
    const people = store("people");
    const persons = each(
      () => people.all(),
      ([id]) => id,
      (person, id) => personRow(id, () => person.value[1], isOwner),
    );
    await openDialog({
      title: "People",
      className: "wv-people",
      isLight: true,
      content: [
        table("Connected", headings, persons),
        ...(isOwner ? ownersPart() : [el("p", { class: "wv-quiet" }, why("Invite"))]),
      ],
    });
    end();
  });

/** The part that only the owner sees: invitations, links, and what others did. */
function ownersPart() {
  const links = store("links");
  const journal = store("journal");
  const rows = () => [...links.all()].map(linkRow);
  return [
    el("h3", {}, "Invite"),
    invitation((link) => copyAndTell(link, "Copied the link.")),
    el(
      "div",
      { hidden: () => links.all().size === 0 }, // as of a viewer that asks for none
      el("h3", {}, "Links"),
      el("div", { class: "wv-people-log" }, table("Links", ["Name", "Role", "Ends", ""], rows)),
    ),
    el("h3", {}, "Log"),
    el(
      "div",
      { class: "wv-people-log" },
      table("Log", ["Time", "Who", "What"], () => (journal.get("entries") ?? []).map(entryRow)),
    ),
  ];
}

/**
 * @param {string} label
 * @param {string[]} columns
 * @param {() => HTMLElement[]} rows
 */
function table(label, columns, rows) {
  const heads = columns.map((name) => el("th", {}, name));
  return el(
    "table",
    { "aria-label": label },
    el("thead", {}, el("tr", {}, heads)),
    el("tbody", {}, rows),
  );
}

/** @param {...(Child | (() => string))} cells */
function line(...cells) {
  return el(
    "tr",
    {},
    cells.map((cell) => el("td", {}, cell)),
  );
}

/** @param {string} id */
const isYou = (id) => id === String(window.webviz.browser);

/**
 * A row that stays, so that its buttons can be used while texts change.
 *
 * @param {string} id
 * @param {() => Person} person
 * @param {boolean} isOwner
 */
function personRow(id, person, isOwner) {
  const addresses = store("addresses");
  const name = () =>
    [person().name || "no link needed", isYou(id) && "(you)"].filter(Boolean).join(" ");
  const latency = () => {
    const { latency_ms: ms } = person();
    return ms === null ? "not measured yet" : `${ms} ms`;
  };
  return line(
    name,
    () => person().role,
    ...(isOwner ? [() => addresses.get(id) ?? ""] : []),
    () => clock(person().since_s),
    latency,
    () => person().drives.join(", "),
    ...(isOwner ? [isYou(id) ? null : endings(Number(id), person())] : []),
  );
}

/**
 * The buttons that end a visit.
 *
 * @param {number} id
 * @param {Person} person
 */
function endings(id, { name }) {
  const who = name || "this browser";
  /**
   * @param {string} label
   * @param {string} tip
   * @param {() => unknown} onclick
   */
  const button = (label, tip, onclick) => textButton(label, onclick, { tip });
  const end = async () => {
    const question = `Disconnect ${who} for now? They may come back${name ? " with their link" : ""}.`;
    if (await ask(question, { title: "End visit", confirm: "End", danger: true })) {
      act("Dismiss", { visitor: id, revokes: false });
    }
  };
  return el(
    "span",
    { class: "wv-people-ends" },
    button("End visit", "Close this page of theirs", end),
    name
      ? button(
          "Revoke link",
          CLOSES_ALL,
          async () => (await isSure(name)) && act("Dismiss", { visitor: id, revokes: true }),
        )
      : null,
  );
}

const CLOSES_ALL = "Close all their pages, for good";

/** @param {string} name */
const isSure = (name) =>
  ask(`Revoke the link of ${name}? All pages that were opened with it are closed.`, {
    title: "Revoke link",
    confirm: "Revoke",
    danger: true,
  });

/** @param {[string, ValidLink]} link */
function linkRow([name, { role, expires_s }]) {
  const isOwn = name === self().name;
  const onclick = async () => (await isSure(name)) && act("Revoke", { name });
  return line(
    isOwn ? `${name} (you)` : name,
    role,
    expires_s === null ? "never" : timeOfDay(expires_s),
    isOwn ? null : textButton("Revoke link", onclick, { tip: CLOSES_ALL }),
  );
}

/** @param {JournalEntry} entry */
const entryRow = ({ time_s, name, role, address, text }) =>
  line(clock(time_s), [name, role, address].filter(Boolean).join(", "), text);

/** @param {number} seconds since 1970 */
const clock = (seconds) => timeOfDay(seconds).split(" ").at(-1) ?? "";
