// Icons by name: paths on a field of 24 x 24.

import { el, svg } from "webviz/dom.js";

/** @import {Attribute} from "webviz/types.js" */

/** @type {Record<string, string>} */
const PATHS = {
  "arrow-back": "M9 14 4 9l5-5M4 9h10a6 6 0 0 1 0 12h-3",
  "arrow-forward": "m15 14 5-5-5-5M20 9H10a6 6 0 0 0 0 12h3",
  axes: "M12 13V3M12 13l8 5M12 13l-8 5",
  bookmark: "M6 3h12v18l-6-5-6 5z",
  camera: "M4 8h4l2-3h4l2 3h4v11H4zM12 16.5a3 3 0 1 0 0-6 3 3 0 0 0 0 6",
  check: "m5 12 5 5L19 7",
  chevron: "m9 6 6 6-6 6",
  "chevron-down": "m6 9 6 6 6-6",
  clock: "M12 21a9 9 0 1 0 0-18 9 9 0 0 0 0 18M12 7v5l3 2",
  close: "M6 6l12 12M18 6 6 18",
  cloud: "M6 16h.01M10 13h.01M14 17h.01M18 12h.01M8 8h.01M13 9h.01M17 7h.01M12 20h.01",
  copy: "M8 8h12v12H8zM4 16V4h12",
  dots: "M4 12a1 1 0 1 0 2 0 1 1 0 1 0-2 0M11 12a1 1 0 1 0 2 0 1 1 0 1 0-2 0M18 12a1 1 0 1 0 2 0 1 1 0 1 0-2 0",
  download: "M12 4v11m-5-4 5 5 5-5M4 20h16",
  eye: "M2 12s4-7 10-7 10 7 10 7-4 7-10 7S2 12 2 12M12 15a3 3 0 1 0 0-6 3 3 0 0 0 0 6",
  file: "M6 3h8l4 4v14H6zM14 3v5h4",
  flag: "M6 21V4h12l-3 4 3 4H6",
  focus: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5M12 12h.01",
  fold: "M4 5h16v14H4zM10 5v14M16 10l-2 2 2 2",
  folder: "M3 6h6l2 2h10v11H3z",
  follow: "M12 3v3M12 18v3M3 12h3M18 12h3M9 15l2-5 4-1-1 4z",
  fullscreen: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
  gear: "M12 15a3 3 0 1 0 0-6 3 3 0 0 0 0 6M12 2v3M12 19v3M2 12h3M19 12h3M5 5l2 2M17 17l2 2M19 5l-2 2M7 17l-2 2",
  grid: "M4 4h16v16H4zM4 9.3h16M4 14.7h16M9.3 4v16M14.7 4v16",
  hand: "M7 12V6.5a1.5 1.5 0 0 1 3 0V11V4.5a1.5 1.5 0 0 1 3 0V11V5.5a1.5 1.5 0 0 1 3 0V12V8a1.5 1.5 0 0 1 3 0v6a7 7 0 0 1-7 7c-4 0-5-2-8-7a1.5 1.5 0 0 1 3-1.5",
  keyboard: "M3 7h18v11H3zM7 11h.01M11 11h.01M15 11h.01M17 14.5H7",
  laser: "M4 18a9 9 0 0 1 16 0M12 18l-6-9M12 18V7M12 18l6-9",
  list: "M8 6h12M8 12h12M8 18h12M4 6h.01M4 12h.01M4 18h.01",
  loop: "M4 12V9a3 3 0 0 1 3-3h12m-3-3 3 3-3 3M20 12v3a3 3 0 0 1-3 3H5m3 3-3-3 3-3",
  map: "M4 6l5-2 6 2 5-2v14l-5 2-6-2-5 2zM9 4v14M15 6v14",
  menu: "M4 6h16M4 12h16M4 18h16",
  moon: "M20 14A8 8 0 1 1 10 4a6.5 6.5 0 0 0 10 10",
  move: "M12 3v18M3 12h18M9 6l3-3 3 3M9 18l3 3 3-3M6 9l-3 3 3 3M18 9l3 3-3 3",
  odometry: "M5 19c0-8 5-10 11-10m-4-4 4 4-4 4",
  orbit: "M12 14a2 2 0 1 0 0-4 2 2 0 0 0 0 4M3 12c0-2.5 4-4.5 9-4.5s9 2 9 4.5-4 4.5-9 4.5",
  path: "M4 18c4 0 4-12 8-12s4 12 8 6",
  pause: "M8 5v14M16 5v14",
  pencil: "M4 20l1-4L16 5l3 3L8 19zM14 7l3 3",
  play: "M7 5l12 7-12 7z",
  plus: "M12 5v14M5 12h14",
  plug: "M12 3l8 4.5v9L12 21l-8-4.5v-9zM12 12l8-4.5M12 12v9M12 12L4 7.5",
  point: "M12 21s6-6 6-11a6 6 0 0 0-12 0c0 5 6 11 6 11M12 11.5a1.5 1.5 0 1 0 0-3 1.5 1.5 0 0 0 0 3",
  pose: "M4 20 20 12 4 4l4 8z",
  pulse: "M3 12h4l3-7 4 14 3-7h4",
  record: "M12 18a6 6 0 1 0 0-12 6 6 0 0 0 0 12",
  refresh: "M20 11a8 8 0 1 0-1 5M20 5v6h-6",
  reset: "M4 11a8 8 0 1 1 1 5M4 5v6h6",
  robot: "M6 9h12v9H6zM12 9V5M9 13h.01M15 13h.01M3 12v4M21 12v4",
  ruler: "M3 15 15 3l6 6L9 21zM7 11l2 2M10 8l3 3M13 5l2 2",
  save: "M5 4h11l3 3v13H5zM8 4v5h7V4M8 20v-6h8v6",
  screen: "M3 5h18v12H3zM8 21h8M12 17v4",
  search: "M11 18a7 7 0 1 0 0-14 7 7 0 0 0 0 14M16 16l5 5",
  select: "M4 8V4h4M16 4h4v4M4 16v4h4M11 11l9 3-4 2-2 4z",
  sidebar: "M4 5h16v14H4zM10 5v14",
  step: "M5 5l10 7-10 7zM19 5v14",
  "step-back": "M19 5 9 12l10 7zM5 5v14",
  sun: "M12 16a4 4 0 1 0 0-8 4 4 0 0 0 0 8M12 2v2M12 20v2M2 12h2M20 12h2M5 5l1.5 1.5M17.5 17.5 19 19M19 5l-1.5 1.5M6.5 17.5 5 19",
  target: "M12 20a8 8 0 1 0 0-16 8 8 0 0 0 0 16M12 2v5M12 17v5M2 12h5M17 12h5",
  trash: "M5 7h14M10 7V4h4v3M7 7l1 13h8l1-13",
  tree: "M6 4v13h6M6 9h6M12 7h7v4h-7zM12 15h7v4h-7z",
  upload: "M12 16V5m-5 5 5-5 5 5M4 20h16",
  wheel:
    "M12 21a9 9 0 1 0 0-18 9 9 0 0 0 0 18M12 14a2 2 0 1 0 0-4 2 2 0 0 0 0 4M3.2 11 10 12M20.8 11 14 12M12 14v7",
};

/**
 * An icon by its name here, or by its own path; a square dot for a name that there is none of.
 *
 * @param {string} name
 * @param {number} [size]
 */
export function icon(name, size = 16) {
  return svg(PATHS[name] ?? (/^M[\s\d]/.test(name) ? name : "M9 9h6v6H9z"), size);
}

/**
 * A button with an icon, whose label is its tooltip, too, unless it has a `tip`.
 *
 * @param {string} name
 * @param {string} label
 * @param {(event: MouseEvent) => unknown} onclick
 * @param {Record<string, Attribute> & {tip?: string | null, size?: number}} [options] and other attributes
 */
export const iconButton = (name, label, onclick, { tip = label, size, ...attributes } = {}) =>
  el(
    "button",
    {
      type: "button",
      class: "wv-icon",
      "aria-label": label,
      "data-tip": tip,
      onclick,
      ...attributes,
    },
    icon(name, size),
  );

/**
 * A button with words, behind an icon if it has one.
 *
 * @param {string} text
 * @param {(event: MouseEvent) => unknown} onclick
 * @param {Record<string, Attribute> & {tip?: string | (() => string), icon?: string}} [options] and others
 */
export const textButton = (text, onclick, { tip, icon: name, ...attributes } = {}) =>
  el(
    "button",
    { type: "button", class: "wv-button", "data-tip": tip, onclick, ...attributes },
    name ? icon(name) : null,
    text,
  );
