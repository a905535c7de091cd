// Draws the tiles of a map, and tracks over them.

import { mercator, pixelOf, TILE } from "./outdoor_mercator.js";

/** @import {Look, Size, Tile, Vec2} from "./outdoor_mercator.js" */

/**
 * @typedef {{topic: string, is_path: boolean, parts: Vec2, newest: Vec2 | null}} Track
 *   `parts` are the numbers of its first part and of that behind its last
 * @typedef {{track: Track, lines: Vec2[]}} Line with places as shares of the world
 */

const DEEPER = 3; // levels above a tile that is missing, of which parts are shown
const HUES = [210, 28, 140, 0, 270, 180, 60, 320];

/**
 * Draws a tile, or the part of one of a lower level until it is there.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Tile} tile
 * @param {{look: Look, size: Size, imageOf: (name: string) => ImageBitmap | null | undefined}} map
 */
export function drawTile(context, [level, column, row], { look, size, imageOf }) {
  const edge = TILE * 2 ** (look.zoom - level);
  const [x, y] = pixelOf([column / 2 ** level, row / 2 ** level], look, size);
  for (let up = 0; up <= DEEPER && up <= level; up++) {
    const image = imageOf([level - up, column >> up, row >> up].join("/"));
    if (!image) continue;
    const part = image.width / 2 ** up;
    const [left, top] = [(column % 2 ** up) * part, (row % 2 ** up) * part];
    // Half a pixel more hides the seams.
    context.drawImage(image, left, top, part, part, x, y, edge + 0.5, edge + 0.5);
    return;
  }
}

/**
 * Draws a track, with a dot at its newest fix.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Line} line
 * @param {{index: number, look: Look, size: Size}} map
 */
export function drawTrack(context, { track, lines }, { index, look, size }) {
  context.strokeStyle = context.fillStyle = `hsl(${HUES[index % HUES.length]} 85% 50%)`;
  context.lineWidth = 3;
  context.lineJoin = "round";
  context.setLineDash(track.is_path ? [8, 5] : []);
  context.beginPath();
  for (const place of lines) context.lineTo(...pixelOf(place, look, size));
  context.stroke();
  context.setLineDash([]);
  if (!track.newest) return;
  context.beginPath();
  context.arc(...pixelOf(mercator(track.newest), look, size), 6, 0, 2 * Math.PI);
  context.fill();
  context.strokeStyle = "#fff";
  context.lineWidth = 2;
  context.stroke();
}
