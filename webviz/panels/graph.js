// The widget "graph": nodes and topics as boxes, from those that send to those that receive.

/** @import {Page} from "../page/web/extensions.js" */

/**
 * @typedef {{name: string, type: string, from: string[], to: [string, string][]}} Topic
 * @typedef {{
 *   key: string, kind: "node" | "topic" | "group", name: string, about: string, topics: string[],
 *   layer: number, x: number, y: number, width: number,
 * }} Box
 * @typedef {{from: Box, to: Box, topics: Set<string>, why: string}} Link
 * @typedef {{boxes: Map<string, Box>, links: Link[], width: number, height: number}} Drawing
 * @typedef {{x: number, y: number, scale: number}} Look
 * @typedef {(topics: Iterable<string>) => string} RateOf
 */

const HEIGHT = 36;
const ROW = 46;
const GAP = 90;
const EDGE = 20;
const LETTER = 6.7;
const NARROWEST = 90;
const WIDEST = 250;
const LONGEST = 36; // characters of a name in a box
const LEAST_ROWS = 18; // of a column, before a layer has several
const SWEEPS = 6;
const FOLD_ABOVE = 60; // boxes
const FURTHEST = 0.02;
const NEAREST = 3;
const SMALLEST_TEXT = 0.35; // of a scale; below it texts would be noise
const SMALLEST_RATE = 0.55;
const WHEEL_STEP = 0.002;
const CLICK_PX = 4;
const RULES = `
.wv-graph-canvas { flex: 1; min-height: 120px; width: 100%; cursor: grab; touch-action: none;
  border: 1px solid var(--wv-line); border-radius: var(--wv-radius); background: var(--wv-field) }
.wv-graph-detail { max-height: 40%; overflow: auto; overflow-wrap: anywhere }
.wv-graph-detail ul { margin: 4px 0; padding-left: 18px }
`;

/** @param {Page} page */
export default function install(page) {
  const { download, el, fitted, iconButton, set, setText, style, svgElement, watch, widget } = page;
  style("graph", RULES);

  widget("graph", () => {
    /** @type {Topic[]} */
    let topics = [];
    let given = ""; // of which topics the drawing is
    /** @type {Set<string>} */
    const opened = new Set(); // namespaces
    /** @type {Set<string> | null} */
    let folded = null; // all namespaces that can be folded; null before the first topics came
    /** @type {Drawing} */
    let drawing = layOut([], () => false);
    /** @type {Look} */
    const look = { x: 0, y: 0, scale: 1 };
    let isWhole = true; // follows the panel until somebody moves or zooms
    let chosen = "";
    let hit = -1;
    let request = 0;
    /** @type {Map<string, number>} */
    let rates = new Map();
    /** @type {(() => void) | null} */
    let unmeasure = null;
    /** @type {{x: number, y: number, isDrag: boolean} | null} */
    let held = null;

    const empty = el("div", { class: "wv-empty", role: "status" });
    const canvas = el("canvas", { class: "wv-graph-canvas", role: "img", tabindex: 0 });
    const search = el("input", {
      class: "wv-field",
      type: "search",
      placeholder: "Find nodes and topics",
      "aria-label": "Find nodes and topics",
      oninput: () => ((hit = -1), soon()),
      onkeydown: (/** @type {KeyboardEvent} */ event) => event.key === "Enter" && goOn(event),
    });
    const count = el("span", { class: "wv-quiet", role: "status" });
    const detail = el("div", { class: "wv-plugin-detail wv-graph-detail", hidden: true });
    const fold = iconButton("fold", "Fold or unfold all namespaces", () => {
      const isFolded = opened.size < (folded?.size ?? 0);
      opened.clear();
      if (isFolded) for (const name of folded ?? []) opened.add(name);
      arrange();
    });
    const fitAll = iconButton("focus", "Show all (0)", showAll);
    const save = iconButton("download", "Download as SVG", () => download("graph.svg", picture()));

    const soon = () => {
      request ||= requestAnimationFrame(show);
    };

    /** @type {RateOf} */
    const rateOf = (names) => {
      const known = [...names].flatMap((name) => rates.get(name) ?? []);
      if (!known.length) return "";
      const most = Math.max(...known);
      return `${most >= 10 ? Math.round(most) : Number(most.toPrecision(2))} Hz`;
    };

    function arrange() {
      drawing = layOut(topics, (namespace) => !opened.has(namespace));
      if (isWhole) fit();
      soon();
    }

    function showAll() {
      isWhole = true;
      soon();
    }

    function fit() {
      const { width, height } = drawing;
      const scale = Math.min(canvas.clientWidth / width, canvas.clientHeight / height, 1);
      look.scale = Math.max(FURTHEST, scale);
      look.x = (width - canvas.clientWidth / look.scale) / 2;
      look.y = (height - canvas.clientHeight / look.scale) / 2;
    }

    const found = () => {
      const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
      if (!words.length) return null;
      /** @param {string} text */
      const has = (text) => words.every((word) => text.toLowerCase().includes(word));
      return (/** @type {Box} */ { name, topics: inner }) => has(name) || inner.some(has);
    };

    function show() {
      request = 0;
      if (!canvas.clientWidth) return;
      if (isWhole) fit();
      const isFound = found();
      const all = [...drawing.boxes.values()];
      const bad = drawing.links.filter(({ why }) => why).length;
      const sum = isFound
        ? `${all.filter(isFound).length} of ${all.length}`
        : `${all.length} boxes${bad ? `, ${bad} QoS mismatch${bad > 1 ? "es" : ""}` : ""}`;
      setText(count, sum);
      set(canvas, { "aria-label": `Graph: ${sum}` });
      const { context, width, height, color } = fitted(canvas);
      draw(context, drawing, { look, width, height, color, isFound, chosen, rateOf });
    }

    /** @param {Box} box */
    function goTo(box) {
      look.scale = Math.max(look.scale, 0.8);
      look.x = box.x + box.width / 2 - canvas.clientWidth / look.scale / 2;
      look.y = box.y + HEIGHT / 2 - canvas.clientHeight / look.scale / 2;
      isWhole = false;
      choose(box.key);
    }

    /** @param {KeyboardEvent} event */
    function goOn(event) {
      event.preventDefault();
      const isFound = found();
      const all = isFound ? [...drawing.boxes.values()].filter(isFound) : [];
      if (!all.length) return;
      hit = (hit + (event.shiftKey ? -1 : 1) + all.length) % all.length;
      goTo(all[hit]);
    }

    /** @param {string} key */
    function choose(key) {
      const box = drawing.boxes.get(key);
      chosen = box ? key : "";
      unmeasure?.();
      unmeasure = null;
      set(detail, { hidden: !box });
      soon();
      if (!box) return;
      // The message of a topic that a page shows is subscribed to, and so has a rate.
      if (box.kind === "topic") unmeasure = watch(`message:${box.name}`, () => {});
      detail.replaceChildren(...about(box));
    }

    /** @param {Box} box */
    function about(box) {
      /** @param {string} title @param {string[]} lines */
      const part = (title, lines) =>
        lines.length
          ? [
              el("div", { class: "wv-quiet" }, title),
              el(
                "ul",
                {},
                lines.slice(0, 100).map((line) => el("li", {}, line)),
              ),
            ]
          : [];
      const mine = drawing.links.filter(({ from, to }) => from === box || to === box);
      const [into, out] = [
        mine.filter(({ to }) => to === box),
        mine.filter(({ to }) => to !== box),
      ];
      const bar = el(
        "div",
        { class: "wv-plugin-bar" },
        el("b", { class: "wv-ellipsis" }, box.name),
        ...foldButtons(box),
        iconButton("close", "Close", () => choose("")),
      );
      const isTopic = box.kind === "topic";
      return [
        bar,
        el("div", { class: "wv-quiet" }, box.about),
        ...part(
          "Does not arrive",
          mine.flatMap(({ why }) => why || []),
        ),
        ...part(
          isTopic ? "Published by" : "Reads",
          into.map(({ from }) => from.name),
        ),
        ...part(
          isTopic ? "Read by" : "Publishes",
          out.map(({ to }) => to.name),
        ),
      ];
    }

    /** @param {Box} box */
    function foldButtons({ name, kind }) {
      const outer = namespacesOf(name).filter((each) => folded?.has(each));
      /** @param {string} text @param {() => void} run */
      const button = (text, run) =>
        el("button", { type: "button", class: "wv-link", onclick: run }, text);
      const open = kind === "group" ? [button("Unfold", () => toggle(name))] : [];
      const inner = outer.filter((each) => opened.has(each)).at(-1);
      return inner ? [...open, button(`Fold ${inner}`, () => toggle(inner))] : open;
    }

    /** @param {string} namespace */
    function toggle(namespace) {
      if (!opened.delete(namespace)) opened.add(namespace);
      arrange();
      choose("");
    }

    function picture() {
      /** @param {string} name */
      const color = (name) => getComputedStyle(canvas).getPropertyValue(`--wv-${name}`);
      return svgOf(drawing, { color, rateOf, svgElement });
    }

    /** @param {number} factor @param {number} [x] @param {number} [y] */
    function zoom(factor, x = canvas.clientWidth / 2, y = canvas.clientHeight / 2) {
      const next = Math.max(FURTHEST, Math.min(look.scale * factor, NEAREST));
      look.x += x / look.scale - x / next;
      look.y += y / look.scale - y / next;
      look.scale = next;
      isWhole = false;
      soon();
    }

    /** @param {PointerEvent | MouseEvent} event */
    const boxAt = ({ offsetX, offsetY }) => {
      const [x, y] = [look.x + offsetX / look.scale, look.y + offsetY / look.scale];
      for (const box of drawing.boxes.values())
        if (x >= box.x && x <= box.x + box.width && y >= box.y && y <= box.y + HEIGHT) return box;
      return null;
    };
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      zoom(2 ** (-event.deltaY * WHEEL_STEP), event.offsetX, event.offsetY);
    });
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      canvas.setPointerCapture(event.pointerId);
      held = { x: event.clientX, y: event.clientY, isDrag: false };
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!held) return;
      const [dx, dy] = [held.x - event.clientX, held.y - event.clientY];
      if (!held.isDrag && Math.hypot(dx, dy) < CLICK_PX) return;
      held = { x: event.clientX, y: event.clientY, isDrag: true };
      Object.assign(look, { x: look.x + dx / look.scale, y: look.y + dy / look.scale });
      isWhole = false;
      soon();
    });
    canvas.addEventListener("pointerup", (event) => {
      if (held && !held.isDrag) choose(boxAt(event)?.key ?? "");
      held = null;
    });
    canvas.addEventListener("dblclick", (event) => {
      const box = boxAt(event);
      if (box?.kind === "group") toggle(box.name);
    });
    canvas.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.key === "+" || event.key === "=") zoom(1.3);
      else if (event.key === "-") zoom(1 / 1.3);
      else if (event.key === "0") showAll();
      else return;
      event.preventDefault();
      event.stopPropagation();
    });

    const sizes = new ResizeObserver(soon);
    sizes.observe(canvas);
    const unwatch = watch("traffic", (all) => {
      rates = new Map([...all].map(([name, { hz }]) => [name, hz]));
      soon();
    });

    /**
     * @param {{parts: number, problem: string}} values
     * @param {(key: string) => {topics: Topic[]} | undefined} part
     */
    function update({ parts = 0, problem = "" }, part) {
      setText(empty, problem);
      set(empty, { hidden: !problem });
      const next = Array.from({ length: parts }, (_, i) => part(String(i))?.topics ?? []).flat();
      const text = JSON.stringify(next);
      if (text === given) return;
      given = text;
      topics = next;
      const isFirst = folded === null && topics.length > 0;
      folded = foldable(topics);
      if (isFirst && boxesOf(topics, () => false).boxes.size <= FOLD_ABOVE)
        for (const name of folded) opened.add(name);
      arrange();
      if (chosen) choose(chosen);
    }

    const element = el(
      "div",
      { class: "wv-plugin-fill" },
      el("div", { class: "wv-plugin-bar" }, search, fold, fitAll, save),
      el("div", { class: "wv-plugin-bar" }, count),
      empty,
      canvas,
      detail,
    );
    return {
      element,
      update,
      close() {
        unmeasure?.();
        unwatch();
        sizes.disconnect();
        cancelAnimationFrame(request);
      },
    };
  });
}

/**
 * The namespaces that a name is in, the outermost first.
 *
 * @param {string} name
 */
function namespacesOf(name) {
  const found = [];
  for (let at = name.indexOf("/", 1); at > 0; at = name.indexOf("/", at + 1))
    found.push(name.slice(0, at));
  return found;
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
function boxesOf(topics, isFolded) {
  const folded = new Set([...foldable(topics)].filter(isFolded));
  /** @type {Map<string, Box>} */
  const boxes = new Map();
  /** @type {{node: Map<string, Box>, topic: Map<string, Box>}} */
  const known = { node: new Map(), topic: new Map() };
  /** @type {BoxOf} */
  const boxOf = (kind, name) => {
    let box = known[kind].get(name);
    if (box) return box;
    const group = namespacesOf(name).find((each) => folded.has(each));
    const key = group ? `group ${group}` : `${kind} ${name}`;
    box = boxes.get(key) ?? {
      ...{ key, kind: group ? "group" : kind, name: group ?? name, about: kind, topics: [] },
      ...{ layer: 0, x: 0, y: 0, width: 0 },
    };
    known[kind].set(name, box);
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
  const done = new Set();
  const ready = boxes.filter((box) => !degrees.get(box));
  // In a loop, the box that the fewest links lead to is first; nodes before topics.
  const rest = boxes.toSorted(
    (a, b) =>
      (degrees.get(a) ?? 0) - (degrees.get(b) ?? 0) ||
      Number(a.kind === "topic") - Number(b.kind === "topic"),
  );
  let at = 0;
  while (done.size < boxes.length) {
    let box = ready.pop();
    while (!box && at < rest.length) {
      if (!done.has(rest[at])) box = rest[at];
      at += 1;
    }
    if (!box) break;
    if (done.has(box)) continue;
    done.add(box);
    for (const { to } of out.get(box) ?? []) {
      if (done.has(to)) continue;
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
 * Draws what is in sight.
 *
 * @param {CanvasRenderingContext2D} context in pixels of the page
 * @param {Drawing} drawing
 * @param {{
 *   look: Look, width: number, height: number, color: (name: string) => string, rateOf: RateOf,
 *   isFound: ((box: Box) => boolean) | null, chosen: string,
 * }} options
 */
function draw(context, { boxes, links }, options) {
  const { look, width, height, isFound, chosen, rateOf } = options;
  const color = remembered(options.color);
  const { x, y, scale } = look;
  context.scale(scale, scale);
  context.translate(-x, -y);
  const [right, bottom] = [x + width / scale, y + height / scale];
  const about = boxes.get(chosen);
  const groups = [
    { color: color("line"), links: /** @type {Link[]} */ ([]), size: 1.2 },
    { color: color("accent"), links: /** @type {Link[]} */ ([]), size: 2 },
    { color: color("error"), links: /** @type {Link[]} */ ([]), size: 2 },
  ];
  for (const link of links) {
    const [x1, y1, x2, y2] = ends(link);
    if (Math.max(y1, y2) < y || Math.min(y1, y2) > bottom) continue;
    if (Math.max(x1, x2) + GAP < x || Math.min(x1, x2) - GAP > right) continue;
    groups[link.why ? 2 : about && (link.from === about || link.to === about) ? 1 : 0].links.push(
      link,
    );
  }
  for (const group of groups) {
    context.strokeStyle = group.color;
    context.lineWidth = Math.max(group.size, 0.7 / scale);
    context.beginPath();
    for (const link of group.links) {
      const [x1, y1, x2, y2, bend] = ends(link);
      context.moveTo(x1, y1);
      if (scale < SMALLEST_TEXT) context.lineTo(x2, y2);
      else context.bezierCurveTo(x1 + bend, y1, x2 - bend, y2, x2, y2);
    }
    context.stroke();
  }
  if (scale >= SMALLEST_RATE) {
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "center";
    for (const { links: some, color: own } of groups) {
      context.fillStyle = own === color("line") ? color("quiet") : own;
      for (const link of some) {
        const [x1, y1, x2, y2] = ends(link);
        const text = [rateOf(link.topics), link.why ? "QoS" : ""].filter(Boolean).join(" · ");
        if (text) context.fillText(text, (x1 + x2) / 2, (y1 + y2) / 2 - 3);
      }
    }
  }
  context.textAlign = "left";
  for (const box of boxes.values()) {
    if (box.x > right || box.x + box.width < x || box.y > bottom || box.y + HEIGHT < y) continue;
    const isHit = isFound?.(box);
    context.globalAlpha = isFound && !isHit ? 0.3 : 1;
    context.fillStyle = box.key === chosen || isHit ? color("chosen") : color("raised");
    context.strokeStyle = isHit || box.key === chosen ? color("accent") : color("quiet");
    context.lineWidth = Math.max(box.key === chosen ? 2.5 : 1, 0.7 / scale);
    if (scale < SMALLEST_TEXT) {
      context.fillRect(box.x, box.y, box.width, HEIGHT);
      context.strokeRect(box.x, box.y, box.width, HEIGHT);
      continue;
    }
    context.setLineDash(box.kind === "group" ? [6, 3] : []);
    context.beginPath();
    context.roundRect(box.x, box.y, box.width, HEIGHT, box.kind === "node" ? HEIGHT / 2 : 4);
    context.fill();
    context.stroke();
    const room = box.width - 16;
    context.fillStyle = color("text");
    context.font = "600 12px system-ui, sans-serif";
    context.fillText(short(box.name), box.x + 10, box.y + 15, room);
    context.fillStyle = color("quiet");
    context.font = "11px system-ui, sans-serif";
    context.fillText(short(box.about), box.x + 10, box.y + 29, room);
  }
  context.globalAlpha = 1;
  context.setLineDash([]);
}

/**
 * A function of a name that asks once for each.
 *
 * @param {(name: string) => string} ask
 */
function remembered(ask) {
  /** @type {Map<string, string>} */
  const known = new Map();
  return (/** @type {string} */ name) => {
    const value = known.get(name) ?? ask(name);
    known.set(name, value);
    return value;
  };
}

/**
 * The ends of a link, and how far its curve bends.
 *
 * @param {Link} link
 * @returns {[number, number, number, number, number]}
 */
function ends({ from, to }) {
  const [x1, x2] = [from.x + from.width, to.x];
  return [x1, from.y + HEIGHT / 2, x2, to.y + HEIGHT / 2, x2 > x1 ? GAP / 2 : GAP];
}

/**
 * The drawing as SVG; texts are texts, whatever they contain.
 *
 * @param {Drawing} drawing
 * @param {{color: (name: string) => string, rateOf: RateOf, svgElement: Page["svgElement"]}} options
 */
function svgOf({ boxes, links, width, height }, { color, rateOf, svgElement }) {
  const root = svgElement("svg", {
    ...{ xmlns: "http://www.w3.org/2000/svg", viewBox: `0 0 ${width} ${height}` },
    ...{ width, height, "font-family": "sans-serif", "font-size": 11 },
  });
  root.append(svgElement("rect", { width, height, fill: color("field") }));
  for (const link of links) {
    const [x1, y1, x2, y2, bend] = ends(link);
    const stroke = color(link.why ? "error" : "quiet");
    const d = `M${x1} ${y1}C${x1 + bend} ${y1} ${x2 - bend} ${y2} ${x2} ${y2}`;
    const path = svgElement("path", { d, stroke, fill: "none" });
    if (link.why) path.append(svgElement("title", {}, link.why));
    root.append(path);
    const rate = rateOf(link.topics);
    if (!rate) continue;
    const [x, y] = [(x1 + x2) / 2, (y1 + y2) / 2 - 3];
    root.append(svgElement("text", { x, y, fill: stroke, "text-anchor": "middle" }, rate));
  }
  for (const { kind, name, about, x, y, width: size } of boxes.values()) {
    const rx = kind === "node" ? HEIGHT / 2 : 4;
    const frame = { x, y, width: size, height: HEIGHT, rx };
    const dash = kind === "group" ? "6 3" : null;
    root.append(
      svgElement("rect", {
        ...frame,
        ...{ fill: color("raised"), stroke: color("quiet"), "stroke-dasharray": dash },
      }),
      svgElement(
        "text",
        { x: x + 10, y: y + 15, fill: color("text"), "font-weight": 600 },
        svgElement("title", {}, name),
        short(name),
      ),
      svgElement("text", { x: x + 10, y: y + 29, fill: color("quiet") }, short(about)),
    );
  }
  return new XMLSerializer().serializeToString(root);
}

/**
 * A text without its middle if it is long: names differ in their ends.
 *
 * @param {string} text
 */
function short(text) {
  if (text.length <= LONGEST) return text;
  return `${text.slice(0, LONGEST / 2)}…${text.slice(1 - LONGEST / 2)}`;
}
