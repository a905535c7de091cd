// The places of panels as this page knows them, and how they change.

import { why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { surviveReload } from "webviz/remember.js";
import { batch, computed, signal } from "webviz/signals.js";
import { EMPTY, namesIn, namesOf } from "webviz/docks/places.js";
import { alone, layoutName } from "webviz/docks/windows.js";

/** @import {Panel} from "webviz/types.js" */
/** @import {Signal} from "webviz/signals.js" */
/** @import {Layout} from "webviz/docks/places.js" */
/** @typedef {{full: string, chosen: string[], own: Layout | null}} Before */
/** @typedef {{key: string, weight: number, names: string[], front: string}} Place */

const PLUGIN = "plugin-";
const MAX_CHOSEN = 100;

const narrow = matchMedia("(max-width: 640px)");
const isNarrow = signal(narrow.matches);
narrow.addEventListener("change", () => (isNarrow.value = narrow.matches));

export const layout = signal(EMPTY);
/** The one of all browsers, from which that of a watcher may differ. */
const common = signal(EMPTY);
/** @type {Signal<readonly {name: string, is_shown: boolean}[]>} */
export const saved = signal([]);
/** Names of layouts for tasks. @type {Signal<readonly string[]>} */
export const templates = signal([]);
/**
 * Of this page before it was loaded again: the panel that filled the window, the tabs that were in
 * front, and its own layout if it had one.
 */
const before = surviveReload(
  "docks",
  /** @returns {Before} */ () => ({
    full: alone ? "" : full.value,
    chosen: chosen.value,
    own: layout.value === common.value ? null : layout.value,
  }),
);
/** The panel that fills the window, "" for none. @type {Signal<string>} */
export const full = signal(alone || (before?.full ?? ""));
/** @type {Signal<Panel[]>} */
export const panels = signal([]);
/** @type {Signal<string[]>} */
const chosen = signal(before?.chosen ?? []); // as tabs of their places, the last one first

/**
 * The name of a panel in layouts.
 *
 * @param {string} name
 */
export const shortName = (name) => (name.startsWith(PLUGIN) ? name.slice(PLUGIN.length) : name);

/** Panels that are never tabs of the side. @type {Signal<Panel[]>} */
export const others = signal([]);

export const panelsByName = computed(
  () => new Map([...panels.value, ...others.value].map((panel) => [shortName(panel.name), panel])),
);
/** Panels are tabs alone: on a phone, and in a window that has one panel. */
export const isTabsOnly = () => isNarrow.value || Boolean(alone);

/**
 * The places of a row, each with the panels that there are and the one that is shown.
 *
 * @param {"beside" | "below"} row
 * @returns {Place[]}
 */
export const placesOf = (row) =>
  isTabsOnly()
    ? []
    : layout.value[row].flatMap((place) => {
        const names = namesIn(place).filter((name) => panelsByName.value.has(name));
        if (!names.length) return [];
        const front = chosen.value.find((name) => names.includes(name)) ?? names[0];
        return [{ key: place.panel, weight: place.weight, names, front }];
      });

export const floating = () =>
  isTabsOnly() ? [] : layout.value.over.filter(({ panel }) => panelsByName.value.has(panel));

/** Names of the panels that are not in the tabs. */
export const placed = computed(() => {
  const names = new Set(isTabsOnly() ? [] : namesOf(layout.value));
  if (full.value) names.add(full.value);
  return names;
});

/** Names of those that are in sight. */
export const visible = computed(() => {
  const rows = [...placesOf("beside"), ...placesOf("below")].map(({ front }) => front);
  const names = new Set([...rows, ...floating().map(({ panel }) => panel)]);
  if (panelsByName.value.has(full.value)) names.add(full.value);
  return [...names];
});

/**
 * Shows a panel in its place.
 *
 * @param {string} name
 */
export function choose(name) {
  chosen.value = [name, ...chosen.value.filter((each) => each !== name)].slice(0, MAX_CHOSEN);
}

/** @param {string} name */
export const fill = (name) => (full.value = full.value === name ? "" : name);

/**
 * Shows another layout: everywhere if this page may, else only here.
 *
 * @param {Layout} next
 */
export async function arrange(next) {
  layout.value = next;
  if (why("SetLayout")) return;
  const { level } = await act("SetLayout", { layout: next, name: layoutName }, { quiet: true });
  if (level === "error") layout.value = common.value;
}

/** @param {Layout} next that the server says */
export function take(next) {
  const own = before?.own;
  if (before) before.own = null;
  batch(() => {
    common.value = next;
    layout.value = own ?? next;
  });
}
