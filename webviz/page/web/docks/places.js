// Places of panels: beside, below and over the scene. Without a document.

/**
 * As in the config, but complete. Of a place with several panels one is shown at a time: `panel`, or
 * one of its `tabs`.
 *
 * @typedef {{panel: string, weight: number, tabs: string[]}} Docked
 * @typedef {{panel: string, left: number, top: number, width: number, height: number}} Floating
 * @typedef {{beside: Docked[], below: Docked[], over: Floating[], width: number, height: number}} Layout
 * @typedef {{left: number, top: number, width: number, height: number}} Box
 * @typedef {{
 *   place: "beside" | "below" | "over" | "tabs", at: number, into?: string, left: number,
 *   top: number, box: Box,
 * }} Target where a panel is dropped: in the row of a place before number `at`, as a tab of the place
 *   of the panel `into`, or over the scene with a corner; `box` is what it covers, in pixels
 * @typedef {Box & {panel: string}} PanelBox
 * @typedef {{
 *   side: Box, scene: Box, beside: Box, below: Box, besideBoxes: PanelBox[], belowBoxes: PanelBox[],
 * }} Boxes of what is on the page, those of docked panels without the one that is dragged
 */

/** @type {Layout} */
export const EMPTY = { beside: [], below: [], over: [], width: 340, height: 240 };

const LEAST = { width: 120, height: 80 };
const MOST = 4000;
const MAX_BESIDE = 0.6; // of what the tabs leave
const MAX_BELOW = 0.7;
const EDGE = 0.22; // of the scene, where a panel is dropped beside or below it
const HEAD = 32; // pixels at the top of a panel, where another becomes a tab beside it
const FLOATING = { width: 0.35, height: 0.4 };

/**
 * The panels of one place.
 *
 * @param {Docked} place
 */
export const namesIn = ({ panel, tabs }) => [panel, ...tabs];

/** @param {Layout} layout */
export const namesOf = ({ beside, below, over }) => [
  ...[...beside, ...below].flatMap(namesIn),
  ...over.map(({ panel }) => panel),
];

/**
 * The layout of the store "layout".
 *
 * @param {{get(key: string): any}} values
 * @returns {Layout}
 */
export const layoutOf = (values) => ({
  beside: values.get("beside") ?? [],
  below: values.get("below") ?? [],
  over: values.get("over") ?? [],
  width: values.get("width") ?? EMPTY.width,
  height: values.get("height") ?? EMPTY.height,
});

/**
 * The place of a panel.
 *
 * @param {Layout} layout
 * @param {string} name
 * @returns {Target["place"]}
 */
export function placeOf(layout, name) {
  for (const place of /** @type {const} */ (["beside", "below"]))
    if (layout[place].some((each) => namesIn(each).includes(name))) return place;
  return layout.over.some(({ panel }) => panel === name) ? "over" : "tabs";
}

/**
 * The width of the panels beside the scene and the height of those below it, in a room of this size.
 *
 * @param {Layout} layout
 * @param {{width: number, height: number}} room
 */
export const sizesIn = ({ width, height }, room) => ({
  width: Math.min(width, Math.max(LEAST.width, MAX_BESIDE * room.width)),
  height: Math.min(height, MAX_BELOW * room.height),
});

/**
 * The layout with another width beside the scene, or height below it.
 *
 * @param {Layout} layout
 * @param {"width" | "height"} key
 * @param {number} pixels
 * @returns {Layout}
 */
export const sized = (layout, key, pixels) => ({
  ...layout,
  [key]: Math.round(Math.max(LEAST[key], Math.min(pixels, MOST))),
});

/**
 * The layout without a panel.
 *
 * @param {Layout} layout
 * @param {string} name
 * @returns {Layout}
 */
export function without(layout, name) {
  /** @param {Docked[]} row */
  const others = (row) =>
    row.flatMap((each) => {
      const [panel, ...tabs] = namesIn(each).filter((one) => one !== name);
      return panel === undefined ? [] : [{ ...each, panel, tabs }];
    });
  return {
    ...layout,
    beside: others(layout.beside),
    below: others(layout.below),
    over: layout.over.filter(({ panel }) => panel !== name),
  };
}

/**
 * The layout with a panel at another place.
 *
 * @param {Layout} layout
 * @param {string} panel
 * @param {Pick<Target, "place" | "at" | "into" | "left" | "top">} target
 * @returns {Layout}
 */
export function moved(layout, panel, { place, at, into, left, top }) {
  const size = layout.over.find((each) => each.panel === panel) ?? FLOATING;
  const next = without(layout, panel);
  if (place === "tabs") return next;
  if (place === "over") {
    const { width, height } = size;
    const corner = { left: within(left, 1 - width), top: within(top, 1 - height) };
    return { ...next, over: [...next.over, { panel, width, height, ...corner }] };
  }
  if (into !== undefined) {
    /** @param {Docked} each @returns {Docked} */
    const join = (each) =>
      namesIn(each).includes(into) ? { ...each, tabs: [...each.tabs, panel] } : each;
    return { ...next, [place]: next[place].map(join) };
  }
  return { ...next, [place]: next[place].toSpliced(at, 0, { panel, weight: 1, tabs: [] }) };
}

/**
 * The layout with two neighbours of a row at other shares of what they have together.
 *
 * @param {Layout} layout
 * @param {"beside" | "below"} place
 * @param {string} panel the first of them
 * @param {string} next
 * @param {number} share of the first
 * @returns {Layout}
 */
export function shared(layout, place, panel, next, share) {
  const row = layout[place];
  const both = row.filter((each) => each.panel === panel || each.panel === next);
  const sum = both.reduce((sum, { weight }) => sum + weight, 0);
  /** @param {number} part */
  const weight = (part) => round(Math.max(0.05, Math.min(part * sum, 20)));
  const weights = { [panel]: weight(share), [next]: weight(1 - share) };
  return {
    ...layout,
    [place]: row.map((each) => ({ ...each, weight: weights[each.panel] ?? each.weight })),
  };
}

/**
 * The layout with another box of a floating panel, in shares of the scene.
 *
 * @param {Layout} layout
 * @param {string} panel
 * @param {Partial<Box>} box
 * @returns {Layout}
 */
export function floated(layout, panel, box) {
  const over = layout.over.map((each) => {
    if (each.panel !== panel) return each;
    const { left, top, width, height } = { ...each, ...box };
    return {
      panel,
      left: round(within(left, 0.95)),
      top: round(within(top, 0.95)),
      width: round(Math.max(0.05, Math.min(width, 1))),
      height: round(Math.max(0.05, Math.min(height, 1))),
    };
  });
  return { ...layout, over };
}

/**
 * The place that a panel would be dropped at, null for none.
 *
 * @param {number} x
 * @param {number} y
 * @param {Boxes} boxes
 * @returns {Target | null}
 */
export function targetAt(x, y, boxes) {
  const { side, scene, beside, below, besideBoxes, belowBoxes } = boxes;
  const corner = { left: (x - scene.left) / scene.width, top: (y - scene.top) / scene.height };
  if (isIn(x, y, side)) return { place: "tabs", at: 0, box: side, ...corner };
  const isBeside = isIn(x, y, beside);
  const isBelow = isIn(x, y, below);
  if (!isBeside && !isBelow && !isIn(x, y, scene)) return null;
  const into = [...besideBoxes, ...belowBoxes].find((box) => isIn(x, y, { ...box, height: HEAD }));
  if (into) {
    const { panel, left, top, width, height } = into;
    const box = { left, top, width, height };
    return { place: isBeside ? "beside" : "below", at: 0, into: panel, box, ...corner };
  }
  const right = scene.left + scene.width - x;
  const bottom = scene.top + scene.height - y;
  if (isBeside || (!isBelow && right < EDGE * scene.width && right <= bottom)) {
    const at = besideBoxes.filter((box) => y > box.top + box.height / 2).length;
    const width = scene.width * EDGE;
    const all = beside.width ? beside : { ...scene, left: scene.left + scene.width - width, width };
    return { place: "beside", at, box: part(all, at, besideBoxes.length, "top"), ...corner };
  }
  if (isBelow || bottom < EDGE * scene.height) {
    const at = belowBoxes.filter((box) => x > box.left + box.width / 2).length;
    const height = scene.height * EDGE;
    const all = below.height ? below : { ...scene, top: scene.top + scene.height - height, height };
    return { place: "below", at, box: part(all, at, belowBoxes.length, "left"), ...corner };
  }
  const width = FLOATING.width * scene.width;
  const height = FLOATING.height * scene.height;
  return { place: "over", at: 0, box: { left: x, top: y, width, height }, ...corner };
}

/**
 * The box of number `at` in a row with one more panel.
 *
 * @param {Box} box
 * @param {number} at
 * @param {number} count
 * @param {"left" | "top"} along
 * @returns {Box}
 */
function part(box, at, count, along) {
  if (along === "top") {
    const height = box.height / (count + 1);
    return { ...box, top: box.top + at * height, height };
  }
  const width = box.width / (count + 1);
  return { ...box, left: box.left + at * width, width };
}

/**
 * @param {number} x
 * @param {number} y
 * @param {Box} box
 */
const isIn = (x, y, { left, top, width, height }) =>
  x >= left && x < left + width && y >= top && y < top + height;

/**
 * @param {number} value
 * @param {number} high
 */
const within = (value, high) => Math.max(0, Math.min(value, high));

/** @param {number} value */
const round = (value) => Math.round(value * 1000) / 1000;
