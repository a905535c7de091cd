// Draws a graph of nodes and topics on a canvas, and as SVG.

import { GAP, HEIGHT, short } from "./graph_layout.js";

/** @import {Box, Drawing, Link} from "./graph_layout.js" */
/** @import {Look, RateOf} from "./graph_view.js" */

const SMALLEST_TEXT = 0.35; // of a scale; below it texts would be noise
const SMALLEST_RATE = 0.55;

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
export function draw(context, { boxes, links }, options) {
  const { look, width, height } = options;
  const { x, y, scale } = look;
  context.scale(scale, scale);
  context.translate(-x, -y);
  const sight = { scale, left: x, top: y, right: x + width / scale, bottom: y + height / scale };
  const pen = { ...options, context, sight, color: remembered(options.color) };
  const groups = linkGroups(pen, links, boxes.get(options.chosen));
  for (const group of groups) strokeLinks(pen, group);
  if (scale >= SMALLEST_RATE) writeRates(pen, groups);
  for (const box of boxes.values()) drawBox(pen, box);
  context.globalAlpha = 1;
  context.setLineDash([]);
}

/**
 * @typedef {Omit<Parameters<typeof draw>[2], "look" | "width" | "height"> & {
 *   context: CanvasRenderingContext2D,
 *   sight: {scale: number, left: number, top: number, right: number, bottom: number},
 * }} Pen
 * @typedef {{color: string, links: Link[], size: number}} LinkGroup
 */

/**
 * The links that are in sight: most, those of the chosen box, and those that do not match.
 *
 * @param {Pen} pen
 * @param {Link[]} links
 * @param {Box | undefined} chosen
 */
function linkGroups({ color, sight }, links, chosen) {
  /** @type {LinkGroup[]} */
  const groups = [
    { color: color("line"), links: [], size: 1.2 },
    { color: color("accent"), links: [], size: 2 },
    { color: color("error"), links: [], size: 2 },
  ];
  for (const link of links) {
    const [x1, y1, x2, y2] = ends(link);
    if (Math.max(y1, y2) < sight.top || Math.min(y1, y2) > sight.bottom) continue;
    if (Math.max(x1, x2) + GAP < sight.left || Math.min(x1, x2) - GAP > sight.right) continue;
    const isOfChosen = chosen && (link.from === chosen || link.to === chosen);
    groups[link.why ? 2 : isOfChosen ? 1 : 0].links.push(link);
  }
  return groups;
}

/**
 * @param {Pen} pen
 * @param {LinkGroup} group
 */
function strokeLinks({ context, sight: { scale } }, { color, links, size }) {
  context.strokeStyle = color;
  context.lineWidth = Math.max(size, 0.7 / scale);
  context.beginPath();
  for (const link of links) {
    const [x1, y1, x2, y2, bend] = ends(link);
    context.moveTo(x1, y1);
    if (scale < SMALLEST_TEXT) context.lineTo(x2, y2);
    else context.bezierCurveTo(x1 + bend, y1, x2 - bend, y2, x2, y2);
  }
  context.stroke();
}

/**
 * @param {Pen} pen
 * @param {LinkGroup[]} groups
 */
function writeRates({ context, color, rateOf }, groups) {
  context.font = "11px system-ui, sans-serif";
  context.textAlign = "center";
  for (const { links, color: own } of groups) {
    context.fillStyle = own === color("line") ? color("quiet") : own;
    for (const link of links) {
      const [x1, y1, x2, y2] = ends(link);
      const text = [rateOf(link.topics), link.why ? "QoS" : ""].filter(Boolean).join(" · ");
      if (text) context.fillText(text, (x1 + x2) / 2, (y1 + y2) / 2 - 3);
    }
  }
}

/**
 * @param {Pen} pen
 * @param {Box} box
 */
function drawBox({ context, color, sight, isFound, chosen }, box) {
  const { scale, left, top, right, bottom } = sight;
  if (box.x > right || box.x + box.width < left) return;
  if (box.y > bottom || box.y + HEIGHT < top) return;
  const isHit = isFound?.(box);
  const isChosen = box.key === chosen;
  context.globalAlpha = isFound && !isHit ? 0.3 : 1;
  context.fillStyle = isChosen || isHit ? color("chosen") : color("raised");
  context.strokeStyle = isHit || isChosen ? color("accent") : color("quiet");
  context.lineWidth = Math.max(isChosen ? 2.5 : 1, 0.7 / scale);
  if (scale < SMALLEST_TEXT) {
    context.fillRect(box.x, box.y, box.width, HEIGHT);
    context.strokeRect(box.x, box.y, box.width, HEIGHT);
    return;
  }
  context.setLineDash(box.kind === "group" ? [6, 3] : []);
  context.beginPath();
  context.roundRect(box.x, box.y, box.width, HEIGHT, box.kind === "node" ? HEIGHT / 2 : 4);
  context.fill();
  context.stroke();
  const room = box.width - 16;
  context.textAlign = "left";
  context.fillStyle = color("text");
  context.font = "600 12px system-ui, sans-serif";
  context.fillText(short(box.name), box.x + 10, box.y + 15, room);
  context.fillStyle = color("quiet");
  context.font = "11px system-ui, sans-serif";
  context.fillText(short(box.about), box.x + 10, box.y + 29, room);
}

/**
 * A function of a name that asks once for each.
 *
 * @param {(name: string) => string} ask
 */
function remembered(ask) {
  /** @type {Map<string, string>} */
  const cache = new Map();
  return (/** @type {string} */ name) => {
    const value = cache.get(name) ?? ask(name);
    cache.set(name, value);
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
 * @param {{color: (name: string) => string, rateOf: RateOf, svgElement: typeof import("webviz/dom.js").svgElement}} options
 */
export function svgOf({ boxes, links, width, height }, { color, rateOf, svgElement }) {
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
