// The values of the cells of a map, which are the indices of its picture: it has a palette.

/** @import {CellGrid} from "./types.js" */

const HEAD = 8; // bytes before the first part of a PNG
const [WIDTH, COLOR_TYPE] = [16, 25]; // places in its header
const PALETTE = 3; // the type of colours of those that have one

/**
 * The index of a pixel of a PNG as webviz writes it, whose rows are not filtered; null if there is none.
 *
 * @param {Uint8Array} png
 * @param {number} x
 * @param {number} y
 */
export async function indexAt(png, x, y) {
  const view = new DataView(png.buffer, png.byteOffset, png.byteLength);
  const width = view.getUint32(WIDTH);
  if (png[COLOR_TYPE] !== PALETTE || x < 0 || x >= width || y < 0) return null;
  /** @type {BlobPart[]} */
  const parts = [];
  for (let at = HEAD; at + HEAD < png.length; at += 12 + view.getUint32(at)) {
    const kind = String.fromCharCode(...png.subarray(at + 4, at + 8));
    if (kind === "IDAT") parts.push(png.slice(at + 8, at + 8 + view.getUint32(at)));
  }
  const stream = new Blob(parts).stream().pipeThrough(new DecompressionStream("deflate"));
  const rows = new Uint8Array(await new Response(stream).arrayBuffer());
  return rows[y * (width + 1) + 1 + x] ?? null;
}

/**
 * Column and row of the cell at a point of a tile, in the tile and in the whole map.
 *
 * @param {CellGrid} grid
 * @param {number[]} point
 */
export function cellAt({ corner: [firstRow, firstColumn], resolution }, [px, py]) {
  const [x, y] = [Math.floor(px / resolution), Math.floor(py / resolution)];
  return { x, y, column: firstColumn + x, row: firstRow + y };
}

/**
 * Title and fields of a cell, all texts, in the words of the display Map.
 *
 * @param {CellGrid} grid
 * @param {{column: number, row: number}} cell
 * @param {number} index of its picture
 */
export function cellDetails({ columns, resolution, origin, axes, frame, told }, cell, index) {
  const { column, row } = cell;
  const middle = origin.map(
    (at, k) => at + resolution * ((column + 0.5) * axes[0][k] + (row + 0.5) * axes[1][k]),
  );
  return {
    title: `Cell ${column}, ${row}`,
    fields: {
      Value: String(told[index]),
      "Column (x)": String(column),
      "Row (y)": String(row),
      Index: String(row * columns + column),
      [`Centre in ${frame}`]: `${middle.map((each) => each.toFixed(4)).join(", ")} m`,
      Resolution: `${Number(resolution.toPrecision(4))} m`,
    },
  };
}
