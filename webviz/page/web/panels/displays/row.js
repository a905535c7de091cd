// One row of the tree: a display, a group, or the options that hold for everything.

import { why } from "webviz/access.js";
import { el, set } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { sanitized } from "webviz/sanitize.js";
import { computed, effect, untracked } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { hertz } from "webviz/words.js";
import { explaining, isSevere, isShared } from "webviz/panels/findings.js";
import { globalOptions, propertiesOf } from "webviz/panels/displays/properties.js";
import { fillHelp } from "webviz/panels/displays/statuses.js";

/** @import {Item} from "webviz/panels/displays/types.js" */
/** @import {Readable} from "webviz/signals.js" */

/**
 * The state of a row: its item, and how it looks here.
 *
 * @typedef {{
 *   isOpen: boolean, isSelected: boolean, isTabStop: boolean, enabled: boolean, hasRate: boolean,
 *   position: number, count: number,
 * }} Look
 * @typedef {Look & {item: Item, name: string}} State
 */

/** @type {Record<Item["level"], string>} */
const LEVELS = { idle: "Idle", ok: "OK", warn: "Warning", error: "Error" };
const MAX_TOOLTIP = 1000;
const GLOBAL = "Global"; // the type of the options that hold for everything

/**
 * The row of an item; `item()` and `look(item)`, how it looks, are read in effects.
 *
 * @param {string} id
 * @param {() => Item} item
 * @param {(item: Item) => Look} look
 */
export function makeRow(id, item, look) {
  const state = computed(() => {
    const { name } = item();
    return { ...look(item()), item: item(), name: sanitized(name) || " " };
  });
  const isGlobal = item().type === GLOBAL;
  const name = el("span", { class: "wv-tree-name" }, () => state.value.name);
  const row = el(
    "div",
    {
      class: "wv-tree-row",
      role: "treeitem",
      style: () => `--depth: ${state.value.item.depth}`,
      "aria-level": () => state.value.item.depth + 1,
      "aria-selected": () => String(state.value.isSelected),
      "aria-expanded": () => String(state.value.isOpen),
      "aria-posinset": () => state.value.position,
      "aria-setsize": () => state.value.count,
      "aria-label": () => state.value.name,
      "aria-checked": () => (isGlobal ? null : String(state.value.enabled)),
      tabindex: () => (state.value.isTabStop ? 0 : -1),
      "data-off": () => !state.value.item.isActive,
      "data-level": () => levelOf(state.value.item),
    },
    head(id, state, name, isGlobal),
  );
  const status = statusOf(isGlobal ? "" : id, state, row);
  row.append(status.line, status.remedy);
  const inside = computed(() => state.value.isOpen && !state.value.item.isGroup);
  const element = el("div", { class: "wv-tree-node", "data-id": id, role: "none" }, row, () =>
    inside.value ? untracked(() => properties(id, item, isGlobal)) : null,
  );
  return { element, row, name };
}

/** @param {Item} item */
const levelOf = ({ isActive, level }) => (isActive ? level : null);

/**
 * @param {string} id
 * @param {() => Item} item
 * @param {boolean} isGlobal
 */
const properties = (id, item, isGlobal) =>
  el(
    "div",
    {
      class: "wv-tree-inside",
      role: "group",
      "aria-label": () => `Properties of ${sanitized(item().name)}`,
    },
    isGlobal ? globalOptions() : propertiesOf(id),
  );

/**
 * @param {string} id
 * @param {Readable<State>} state
 * @param {HTMLElement} name
 * @param {boolean} isGlobal
 */
function head(id, state, name, isGlobal) {
  const button = { type: "button", tabindex: -1 };
  const kind = computed(() => state.value.item.icon);
  const level = () => levelOf(state.value.item);
  return el(
    "div",
    { class: "wv-tree-head" },
    el(
      "button",
      {
        ...button,
        class: "wv-tree-fold",
        "data-part": "fold",
        "aria-label": () => `${state.value.isOpen ? "Fold" : "Unfold"} ${state.value.name}`,
      },
      icon("chevron", 12),
    ),
    isGlobal ? el("span", { class: "wv-tree-box" }) : checkbox(state),
    el(
      "span",
      {
        class: "wv-tree-type",
        "data-icon": () => kind.value,
        "data-tip": () => (isGlobal ? null : sanitized(state.value.item.type) || null),
      },
      () => icon(kind.value),
    ),
    name,
    el("span", { class: "wv-tree-note" }, () => noteOf(id, state.value, isGlobal)),
    isGlobal
      ? null
      : el(
          "button",
          {
            ...button,
            class: "wv-icon wv-tree-more",
            "data-part": "more",
            "aria-haspopup": "menu",
            "aria-label": () => `Actions for ${state.value.name}`,
          },
          icon("dots"),
        ),
    el("span", {
      class: "wv-tree-dot",
      "data-tip": () => LEVELS[level() ?? "idle"],
      hidden: () => !level(),
    }),
  );
}

/** @param {Readable<State>} state */
function checkbox(state) {
  const box = el("input", {
    type: "checkbox",
    tabindex: -1,
    "data-part": "box",
    "aria-label": () => `Show ${state.value.name}`,
    disabled: () => !state.value.item.can_edit || why("SetProperty", { path: "enabled" }) !== "",
  });
  effect(() => {
    if (box.checked !== state.value.enabled) box.checked = state.value.enabled;
  });
  return el("label", { class: "wv-tree-box", "data-part": "box" }, box);
}

/**
 * The note behind a name: the rate of a display that is looked at.
 *
 * @param {string} id
 * @param {State} state
 * @param {boolean} isGlobal
 */
function noteOf(id, { item, hasRate }, isGlobal) {
  if (isGlobal) return sanitized(item.note ?? "");
  if (!hasRate || !item.topics.length) return "";
  const rate = store(`rate:${id}`);
  const hz = rate.get("hz");
  return hz === undefined ? "" : hertz(hz, rate.get("is_latched"));
}

/**
 * The line below the name and what helps with it. Without a line the viewer says it on top, or the
 * displays of a group do.
 *
 * @param {string} display "" for the viewer
 * @param {Readable<State>} state
 * @param {HTMLElement} row
 */
function statusOf(display, state, row) {
  const sentence = computed(() => {
    const { item, isOpen } = state.value;
    // What a group says is said again by what is in it.
    return item.isActive && !(item.isGroup && isOpen) ? sanitized(item.line, MAX_TOOLTIP) : "";
  });
  const finding = computed(() => {
    const { item } = state.value;
    // A group repeats a status of a display in it.
    return sentence.value ? explaining(display, item.isGroup ? undefined : item.status) : undefined;
  });
  // One that is behind several displays stands above all of them, once.
  const isAbove = () => finding.value !== undefined && isShared(finding.value);
  const cause = () => (finding.value && isSevere(finding.value) ? finding.value.cause : "");
  const isShown = () => sentence.value !== "" && !isAbove();
  const line = el(
    "div",
    {
      class: "wv-tree-status",
      id: `wv-status-${state.value.item.id}`,
      "data-tip": () => (cause() ? null : sentence.value || null),
      "data-cause": () => cause() !== "",
      hidden: () => !isShown(),
    },
    () => cause() || sentence.value,
  );
  const remedy = el("div", { class: "wv-tree-remedy", "data-part": "remedy", hidden: true });
  set(row, {
    "aria-describedby": () => (isShown() ? line.id : null),
    "aria-description": () => (isAbove() ? cause() : null),
  });
  effect(() => {
    const own = finding.value?.button ?? state.value.item.remedy ?? null;
    fillHelp(remedy, isShown() ? own : null, isAbove() ? undefined : finding.value);
  });
  return { line, remedy };
}
