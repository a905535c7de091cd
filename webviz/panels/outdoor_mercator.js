// Places and tiles of a map in Web Mercator. Without a document.

/**
 * @typedef {[number, number]} Vec2
 * @typedef {[number, number, number]} Tile level, column and row
 * @typedef {{x: number, y: number, zoom: number}} Look the middle as shares of the world, and the level
 * @typedef {{width: number, height: number}} Size of a canvas, in pixels
 */

export const TILE = 256; // pixels of a tile at its own level
export const FURTHEST = 1;
const NEAREST = 21;

/**
 * A place as shares of the world, from the north-west.
 *
 * @param {Vec2} place longitude and latitude in degrees
 * @returns {Vec2}
 */
export function mercator([longitude, latitude]) {
  const sine = Math.sin((latitude * Math.PI) / 180);
  const y = 0.5 - Math.log((1 + sine) / (1 - sine)) / (4 * Math.PI);
  return [longitude / 360 + 0.5, y];
}

/**
 * The longitude and latitude of shares of the world, in degrees.
 *
 * @param {Vec2} share
 * @returns {Vec2}
 */
export function unmercator([x, y]) {
  const latitude = (Math.atan(Math.sinh(Math.PI * (1 - 2 * y))) * 180) / Math.PI;
  return [(x - 0.5) * 360, latitude];
}

/**
 * The tiles in sight, those in the middle first.
 *
 * @param {Look} look
 * @param {Size} size
 * @returns {Tile[]}
 */
export function tilesOf({ x, y, zoom }, { width, height }) {
  const level = Math.max(0, Math.min(Math.round(zoom), NEAREST));
  const count = 2 ** level;
  const size = TILE * 2 ** (zoom - level);
  const [left, top] = [x * count - width / size / 2, y * count - height / size / 2];
  /** @type {Tile[]} */
  const tiles = [];
  for (let row = Math.floor(top); row < top + height / size; row++)
    for (let column = Math.floor(left); column < left + width / size; column++)
      if (row >= 0 && row < count && column >= 0 && column < count)
        tiles.push([level, column, row]);
  /** @param {Tile} tile */
  const far = ([, column, row]) => Math.hypot(column + 0.5 - x * count, row + 0.5 - y * count);
  return tiles.toSorted((a, b) => far(a) - far(b));
}

/**
 * The pixel of a place.
 *
 * @param {Vec2} place as shares of the world
 * @param {Look} look
 * @param {Size} size
 * @returns {Vec2}
 */
export function pixelOf([x, y], look, { width, height }) {
  const world = TILE * 2 ** look.zoom;
  return [(x - look.x) * world + width / 2, (y - look.y) * world + height / 2];
}

/**
 * The place at a pixel, as shares of the world.
 *
 * @param {Vec2} pixel
 * @param {Look} look
 * @param {Size} size
 * @returns {Vec2}
 */
export function placeAt([x, y], look, { width, height }) {
  const world = TILE * 2 ** look.zoom;
  return [look.x + (x - width / 2) / world, look.y + (y - height / 2) / world];
}

/**
 * The look some levels nearer; what is at a pixel stays there.
 *
 * @param {Look} look
 * @param {number} by
 * @param {Vec2} pixel
 * @param {Size} size
 * @returns {Look}
 */
export function zoomed(look, by, pixel, size) {
  const zoom = Math.max(FURTHEST, Math.min(look.zoom + by, NEAREST));
  const [x, y] = placeAt(pixel, look, size);
  const [nextX, nextY] = placeAt(pixel, { ...look, zoom }, size);
  return { x: look.x + x - nextX, y: look.y + y - nextY, zoom };
}
