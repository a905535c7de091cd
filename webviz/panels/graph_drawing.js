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
