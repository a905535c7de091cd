// One row of the tree: a display, a group, or the options that hold for everything.

import { why } from "../../access.js";
import { el, set, setText } from "../../dom.js";
import { icon } from "../../icons.js";
import { sanitized } from "../../sanitize.js";
import { effect, signal } from "../../signals.js";
import { watch } from "../../stores.js";
import { hertz } from "../../words.js";
import { explaining, isSevere, isShared } from "../findings.js";
import { properties } from "./properties.js";
import { fillHelp } from "./statuses.js";

/** @import {Item} from "./types.js" */
/** @import {RemedyButton} from "../../contents.js" */
/** @import {Signal} from "../../signals.js" */

/**
 * @typedef {{
 *   isOpen: boolean, isSelected: boolean, isTabStop: boolean, enabled: boolean, hasRate: boolean,
 *   position: number, count: number,
 * }} Look
 */

/** @type {Record<Item["level"], string>} */
const LEVELS = { idle: "Idle", ok: "OK", warn: "Warning", error: "Error" };
const MAX_TOOLTIP = 1000;

/**
 * The row of an item. `look(item)` says how it looks: `{isOpen, isSelected, isTabStop, enabled,
 * hasRate, position, count}`.
 *
 * @param {Item} first
 * @param {(item: Item) => Look} look
 */
export function makeRow(first, look) {
  const { id, type } = first;
  const isGlobal = type === "Global";
  const fold = el(
    "button",
    { type: "button", class: "wv-tree-fold", tabindex: -1, "data-part": "fold" },
    icon("chevron", 12),
  );
  const box = el("input", { type: "checkbox", tabindex: -1, "data-part": "box" });
  const name = el("span", { class: "wv-tree-name" });
  const note = el("span", { class: "wv-tree-note" });
  const more = el(
    "button",
    {
      type: "button",
      class: "wv-icon wv-tree-more",
      tabindex: -1,
      "data-part": "more",
      "aria-haspopup": "menu",
    },
    icon("dots"),
  );
  const kind = el("span", { class: "wv-tree-type" });
  const dot = el("span", { class: "wv-tree-dot" });
  const line = el("div", { class: "wv-tree-status", id: `wv-status-${id}` });
  const head = el(
    "div",
    { class: "wv-tree-head" },
    fold,
    isGlobal
      ? el("span", { class: "wv-tree-box" })
      : el("label", { class: "wv-tree-box", "data-part": "box" }, box),
    kind,
    name,
    note,
    isGlobal ? null : more,
    dot,
  );
  const remedy = el("div", { class: "wv-tree-remedy", "data-part": "remedy", hidden: true });
  const row = el("div", { class: "wv-tree-row", role: "treeitem" }, head, line, remedy);
  const element = el("div", { class: "wv-tree-node", "data-id": id, role: "none" }, row);
  /** @type {{place: HTMLElement, end: () => void} | null} */
  let inside = null;
  /** @type {(() => void) | null} */
  let unwatch = null;
  /** @type {Signal<{said: string, status?: string, remedy: RemedyButton | null}>} */
  const shown = signal({ said: "", remedy: null });

  /**
   * @param {boolean} isShown
   * @param {Item} item
   */
  function showInside(isShown, item) {
    if (isShown === Boolean(inside)) return;
    if (inside) {
      inside.end();
      inside.place.remove();
      inside = null;
    } else {
      const label = `Properties of ${sanitized(item.name)}`;
      const place = el("div", { class: "wv-tree-inside", role: "group", "aria-label": label });
      element.append(place);
      inside = { place, end: properties(place, isGlobal ? "" : id) };
    }
  }

  /** @param {boolean} isShown */
  function showRate(isShown) {
    if (isShown === Boolean(unwatch)) return;
    unwatch?.();
    unwatch = isShown
      ? watch(`rate:${id}`, (values) => {
          const hz = values.get("hz");
          setText(note, hz === undefined ? "" : hertz(hz, values.get("is_latched")));
        })
      : null;
    if (!isShown) setText(note, "");
  }

  /** @param {Item} item */
  function update(item) {
    const { isOpen, isSelected, isTabStop, enabled, hasRate, position, count } = look(item);
    const text = sanitized(item.name) || " ";
    // What a group says is said again by what is in it.
    const said =
      item.isActive && !(item.isGroup && isOpen) ? sanitized(item.line, MAX_TOOLTIP) : "";
    const level = item.isActive ? item.level : null;
    set(row, {
      "aria-level": item.depth + 1,
      "aria-selected": String(isSelected),
      "aria-expanded": String(isOpen),
      "aria-posinset": position,
      "aria-setsize": count,
      "aria-label": text,
      "aria-checked": isGlobal ? null : String(enabled),
      tabindex: isTabStop ? 0 : -1,
      "data-off": !item.isActive,
      "data-level": level,
    });
    row.style.setProperty("--depth", String(item.depth));
    set(fold, { "aria-label": `${isOpen ? "Fold" : "Unfold"} ${text}` });
    set(box, {
      "aria-label": `Show ${text}`,
      disabled: (!isGlobal && !item.can_edit) || why("SetProperty", { path: "enabled" }) !== "",
    });
    if (box.checked !== enabled) box.checked = enabled;
    if (kind.dataset.icon !== item.icon) {
      set(kind, { "data-icon": item.icon });
      kind.replaceChildren(icon(item.icon));
    }
    set(kind, { "data-tip": isGlobal ? null : sanitized(item.type) || null });
    setText(name, text);
    set(more, { "aria-label": `Actions for ${text}` });
    set(dot, { "data-tip": level && LEVELS[level], hidden: !level });
    // A group repeats a status of a display in it.
    shown.value = {
      said,
      status: item.isGroup ? undefined : item.status,
      remedy: item.remedy ?? null,
    };
    if (isGlobal) setText(note, sanitized(item.note ?? ""));
    else showRate(hasRate && item.topics.length > 0);
    showInside(isOpen && !item.isGroup, item);
  }

  function close() {
    showInside(false, first);
    showRate(false);
    forget();
  }

  update(first);
  // Without a line the viewer says it on top, or the group's displays do.
  const forget = effect(() => {
    const { said, status, remedy: own } = shown.value;
    const finding = said ? explaining(isGlobal ? "" : id, status) : undefined;
    const cause = finding && isSevere(finding) ? finding.cause : "";
    // One that is behind several displays stands above all of them, once.
    const isAbove = finding !== undefined && isShared(finding);
    setText(line, cause || said);
    set(line, { "data-tip": cause ? null : said || null, hidden: !said || isAbove });
    line.toggleAttribute("data-cause", cause !== "");
    set(row, {
      "aria-describedby": said && !isAbove ? line.id : null,
      "aria-description": isAbove ? cause : null,
    });
    fillHelp(
      remedy,
      said && !isAbove ? (finding?.button ?? own) : null,
      isAbove ? undefined : finding,
    );
  });
  return { element, row, name, update, close };
}
