// The boxes and links of a graph of nodes and topics, and their places in layers. Without a document.

/**
 * @typedef {{name: string, type: string, from: string[], to: [string, string][]}} Topic
 * @typedef {{
 *   key: string, kind: "node" | "topic" | "group", name: string, about: string, topics: string[],
 *   layer: number, x: number, y: number, width: number,
 * }} Box
 * @typedef {{from: Box, to: Box, topics: Set<string>, why: string}} Link
 * @typedef {{boxes: Map<string, Box>, links: Link[], width: number, height: number}} Drawing
 */

export const HEIGHT = 36;
export const GAP = 90;
const ROW = 46;
const EDGE = 20;
const LETTER = 6.7;
const NARROWEST = 90;
const WIDEST = 250;
const LONGEST = 36; // characters of a name in a box
const LEAST_ROWS = 18; // of a column, before a layer has several
const SWEEPS = 6;

/**
 * The namespaces that a name is in, the outermost first.
 *
 * @param {string} name
 */
export function namespacesOf(name) {
  const namespaces = [];
  for (let at = name.indexOf("/", 1); at > 0; at = name.indexOf("/", at + 1))
    namespaces.push(name.slice(0, at));
  return namespaces;
}

/**
 * The namespaces with more than one name.
 *
 * @param {Topic[]} topics
 */
export function foldable(topics) {
  /** @type {Set<string>} */
  const names = new Set();
  for (const { name, from, to } of topics) {
    names.add(name);
    for (const node of from) names.add(node);
    for (const [reader] of to) names.add(reader);
  }
  /** @type {Map<string, number>} */
  const counts = new Map();
  for (const name of names)
    for (const each of namespacesOf(name)) counts.set(each, (counts.get(each) ?? 0) + 1);
  return new Set([...counts.keys()].filter((each) => (counts.get(each) ?? 0) > 1));
}

/**
 * The box of a node or topic, which is that of the outermost folded namespace that it is in.
 *
 * @typedef {(kind: "node" | "topic", name: string) => Box} BoxOf
 */

/**
 * The boxes by key, and the box of each name.
 *
 * @param {Topic[]} topics
 * @param {(namespace: string) => boolean} isFolded
 * @returns {{boxes: Map<string, Box>, boxOf: BoxOf}}
 */
export function boxesOf(topics, isFolded) {
  const folded = new Set([...foldable(topics)].filter(isFolded));
  /** @type {Map<string, Box>} */
  const boxes = new Map();
  /** @type {{node: Map<string, Box>, topic: Map<string, Box>}} */
  const index = { node: new Map(), topic: new Map() };
  /** @type {BoxOf} */
  const boxOf = (kind, name) => {
    let box = index[kind].get(name);
    if (box) return box;
    const group = namespacesOf(name).find((each) => folded.has(each));
    const key = group ? `group ${group}` : `${kind} ${name}`;
    box = boxes.get(key) ?? {
      ...{ key, kind: group ? "group" : kind, name: group ?? name, about: kind, topics: [] },
      ...{ layer: 0, x: 0, y: 0, width: 0 },
    };
    index[kind].set(name, box);
    boxes.set(key, box);
    return box;
  };
  for (const { name, type } of topics) {
    const box = boxOf("topic", name);
    box.topics.push(name);
    box.about = type;
  }
  for (const { from, to } of topics) {
    for (const node of from) boxOf("node", node);
    for (const [reader] of to) boxOf("node", reader);
  }
  for (const box of boxes.values()) {
    if (box.kind === "group") box.about = `${box.topics.length} topics, folded`;
    const letters = Math.max(short(box.name).length, short(box.about).length);
    box.width = Math.max(NARROWEST, Math.min(letters * LETTER + 20, WIDEST));
  }
  return { boxes, boxOf };
}

/**
 * Lays out boxes in layers, so that most links lead to the right.
 *
 * @param {Topic[]} topics
 * @param {(namespace: string) => boolean} isFolded
 * @returns {Drawing}
 */
export function layOut(topics, isFolded) {
  const { boxes, boxOf } = boxesOf(topics, isFolded);
  const every = [...boxes.values()];
  /** @type {Link[]} */
  const links = [];
  /** @type {Map<Box, Map<Box, Link>>} */
  const between = new Map(every.map((box) => [box, new Map()]));
  /** @param {Box} from @param {Box} to @param {string} topic @param {string} why */
  const link = (from, to, topic, why) => {
    if (from === to) return;
    let one = between.get(from)?.get(to);
    if (!one) {
      one = { from, to, topics: new Set(), why: "" };
      between.get(from)?.set(to, one);
      links.push(one);
    }
    one.topics.add(topic);
    one.why ||= why;
  };
  for (const { name, from, to } of topics) {
    const box = boxOf("topic", name);
    for (const node of from) link(boxOf("node", node), box, name, "");
    for (const [node, why] of to) link(box, boxOf("node", node), name, why);
  }
  layer(every, links);
  return { boxes, links, ...place(every, links) };
}

/**
 * Gives each box its layer: one more than those that lead to it, apart from links that close loops.
 *
 * @param {Box[]} boxes
 * @param {Link[]} links
 */
function layer(boxes, links) {
  /** @type {Map<Box, Link[]>} */
  const out = new Map(boxes.map((box) => [box, []]));
  /** @type {Map<Box, number>} */
  const degrees = new Map(boxes.map((box) => [box, 0]));
  for (const each of links) {
    out.get(each.from)?.push(each);
    degrees.set(each.to, (degrees.get(each.to) ?? 0) + 1);
  }
  /** @type {Set<Box>} */
  const visitedBoxes = new Set();
  const ready = boxes.filter((box) => !degrees.get(box));
  // In a loop, the box that the fewest links lead to is first; nodes before topics.
  const rest = boxes.toSorted(
    (a, b) =>
      (degrees.get(a) ?? 0) - (degrees.get(b) ?? 0) ||
      Number(a.kind === "topic") - Number(b.kind === "topic"),
  );
  let at = 0;
  while (visitedBoxes.size < boxes.length) {
    let box = ready.pop();
    while (!box && at < rest.length) {
      if (!visitedBoxes.has(rest[at])) box = rest[at];
      at += 1;
    }
    if (!box) break;
    if (visitedBoxes.has(box)) continue;
    visitedBoxes.add(box);
    for (const { to } of out.get(box) ?? []) {
      if (visitedBoxes.has(to)) continue;
      to.layer = Math.max(to.layer, box.layer + 1);
      const left = (degrees.get(to) ?? 0) - 1;
      degrees.set(to, left);
      if (!left) ready.push(to);
    }
  }
}

/**
 * Gives each box its place; neighbours of a layer stand near what they are linked with.
 *
 * @param {Box[]} boxes
 * @param {Link[]} links
 */
function place(boxes, links) {
  /** @type {Box[][]} */
  const layers = [];
  for (const box of boxes.toSorted((a, b) => (a.name < b.name ? -1 : 1)))
    (layers[box.layer] ??= []).push(box);
  const full = layers.filter(Boolean);
  /** @type {Map<Box, Box[]>} */
  const linked = new Map(boxes.map((box) => [box, []]));
  for (const { from, to } of links) {
    linked.get(from)?.push(to);
    linked.get(to)?.push(from);
  }
  /** @type {Map<Box, number>} */
  const order = new Map();
  const number = (/** @type {Box[]} */ row) =>
    row.forEach((box, i) => order.set(box, (i + 0.5) / row.length));
  full.forEach(number);
  for (let sweep = 0; sweep < SWEEPS; sweep++) {
    for (const row of sweep % 2 ? full.toReversed() : full) {
      /** @type {Map<Box, number>} */
      const wish = new Map();
      for (const box of row) {
        const around = linked.get(box) ?? [];
        const sum = around.reduce((total, each) => total + (order.get(each) ?? 0), 0);
        wish.set(box, around.length ? sum / around.length : (order.get(box) ?? 0));
      }
      row.sort((a, b) => (wish.get(a) ?? 0) - (wish.get(b) ?? 0));
      number(row);
    }
  }
  // A long layer has several columns, else the drawing would be high and narrow.
  const rows = Math.max(LEAST_ROWS, Math.ceil(Math.sqrt(boxes.length) * 1.5));
  let x = EDGE;
  let height = 0;
  for (const layer of full) {
    const columns = Math.ceil(layer.length / rows);
    const size = Math.ceil(layer.length / columns);
    for (let column = 0; column < columns; column++) {
      const part = layer.slice(column * size, (column + 1) * size);
      const width = Math.max(...part.map((box) => box.width));
      part.forEach((box, i) => Object.assign(box, { x, y: EDGE + i * ROW, width }));
      height = Math.max(height, part.length * ROW);
      x += width + (column < columns - 1 ? 24 : GAP);
    }
  }
  for (const layer of full) {
    const low = Math.max(...layer.map(({ y }) => y)) + ROW - EDGE;
    for (const box of layer) box.y += (height - low) / 2;
  }
  return { width: Math.max(1, x - GAP + EDGE), height: height + 2 * EDGE };
}

/**
 * A text without its middle if it is long: names differ in their ends.
 *
 * @param {string} text
 */
export function short(text) {
  if (text.length <= LONGEST) return text;
  return `${text.slice(0, LONGEST / 2)}…${text.slice(1 - LONGEST / 2)}`;
}
