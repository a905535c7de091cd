// Who is connected and what they did, and how the owner invites others.

import { onRole, self, why } from "../access.js";
import { act } from "../act.js";
import { copyAndTell } from "../clipboard.js";
import { el, setText } from "../dom.js";
import { textButton } from "../icons.js";
import { watch } from "../stores.js";
import { ask, openDialog } from "../controls/dialog.js";
import { invitation } from "./invitation.js";

/** @import {JournalLine, Person, ValidLink} from "../contents.js" */
/** @import {ValuesOf} from "../types.js" */

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
  /**
   * @type {{
   *   people: ValuesOf<"people">, addresses: ValuesOf<"addresses">, links: ValuesOf<"links">,
   *   journal: ValuesOf<"journal"> | null,
   * }}
   */
  const known = { people: new Map(), addresses: new Map(), journal: null, links: new Map() };
  const here = el("tbody");
  const links = el("tbody");
  const allLinks = el(
    "div",
    { hidden: true },
    el("h3", {}, "Links"),
    el("div", { class: "wv-people-log" }, table("Links", ["Name", "Role", "Ends", ""], links)),
  );
  const done = el("tbody");
  /** @type {Map<string, HTMLElement>} */
  const rows = new Map(); // which stay, so that their buttons can be used while texts change
  const show = () => {
    for (const [id, row] of rows) {
      if (known.people.has(id)) continue;
      row.remove();
      rows.delete(id);
    }
    for (const [id, person] of known.people) {
      const texts = textsOf(id, person, known.addresses, isOwner);
      const row = rows.get(id) ?? cells(...texts);
      if (!rows.has(id)) {
        if (isOwner) row.append(el("td", {}, isYou(id) ? null : endings(Number(id), person)));
        here.append(row);
      }
      rows.set(id, row);
      texts.forEach((text, index) => setText(row.children[index], text));
    }
    done.replaceChildren(...(known.journal?.get("entries") ?? []).map(entryRow));
  };
  const showLinks = () => {
    links.replaceChildren(...[...known.links].map(linkRow));
    allLinks.hidden = known.links.size === 0; // as of a viewer that asks for none
  };
  /** @type {(keyof typeof known)[]} */
  const stores = isOwner ? ["people", "addresses", "journal", "links"] : ["people"];
  const ends = stores.map((name) =>
    watch(name, (values) => {
      Object.assign(known, { [name]: values });
      (name === "links" ? showLinks : show)();
    }),
  );
  const columns = [
    "Name",
    "Role",
    ...(isOwner ? ["Address"] : []),
    "Since",
    "Latency",
    "Drives",
    ...(isOwner ? [""] : []),
  ];
  await openDialog({
    title: "People",
    className: "wv-people",
    isLight: true,
    content: [
      table("Connected", columns, here),
      ...(isOwner
        ? [
            el("h3", {}, "Invite"),
            invitation((link) => copyAndTell(link, "Copied the link.")),
            allLinks,
            el("h3", {}, "Log"),
            el("div", { class: "wv-people-log" }, table("Log", ["Time", "Who", "What"], done)),
          ]
        : [el("p", { class: "wv-quiet" }, why("Invite"))]),
    ],
  });
  ends.forEach((end) => end());
}

/**
 * @param {string} label
 * @param {string[]} columns
 * @param {HTMLElement} body
 */
const table = (label, columns, body) =>
  el(
    "table",
    { "aria-label": label },
    el(
      "thead",
      {},
      el(
        "tr",
        {},
        columns.map((name) => el("th", {}, name)),
      ),
    ),
    body,
  );

/** @param {...string} texts */
const cells = (...texts) =>
  el(
    "tr",
    {},
    texts.map((text) => el("td", {}, text)),
  );

/** @param {string} id */
const isYou = (id) => id === String(window.webviz.browser);

/**
 * @param {string} id
 * @param {Person} person
 * @param {ValuesOf<"addresses">} addresses
 * @param {boolean} isOwner
 */
function textsOf(id, person, addresses, isOwner) {
  const name = [person.name || "no link needed", isYou(id) && "(you)"].filter(Boolean).join(" ");
  return [
    name,
    person.role,
    ...(isOwner ? [addresses.get(id) ?? ""] : []),
    timeOf(person.since_s),
    person.latency_ms === null ? "not measured yet" : `${person.latency_ms} ms`,
    person.drives.join(", "),
  ];
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
    const question = `End this visit of ${who}? They may come back${name ? " with their link" : ""}.`;
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
  const row = cells(
    isOwn ? `${name} (you)` : name,
    role,
    expires_s === null ? "never" : new Date(expires_s * 1000).toLocaleString(),
  );
  const onclick = async () => (await isSure(name)) && act("Revoke", { name });
  const button = textButton("Revoke link", onclick, { tip: CLOSES_ALL });
  row.append(el("td", {}, isOwn ? null : button));
  return row;
}

/** @param {JournalLine} entry */
const entryRow = ({ time_s, name, role, address, text }) =>
  cells(timeOf(time_s), [name, role, address].filter(Boolean).join(", "), text);

/** @param {number} seconds */
const timeOf = (seconds) => new Date(seconds * 1000).toLocaleTimeString();
