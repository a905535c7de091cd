// Images without lens distortion: a grid of triangles, whose
// corners the server computes.

import { computed } from "webviz/signals.js";

/** @import {PictureWarp} from "webviz/messages.js" */
/** @import {Vec2} from "webviz/types.js" */

/** @typedef {(image: TexImageSource, warp: PictureWarp, width: number, height: number) => HTMLCanvasElement} Bench */

const VERTEX = `
  attribute vec2 to;
  attribute vec2 from;
  varying vec2 place;
  void main() {
    place = from;
    gl_Position = vec4(2.0 * to.x - 1.0, 1.0 - 2.0 * to.y, 0.0, 1.0);
  }`;
const FRAGMENT = `
  precision highp float;
  uniform sampler2D image;
  varying vec2 place;
  void main() {
    if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(1.0)))) discard;
    gl_FragColor = texture2D(image, place);
  }`;

const bench = computed(makeBench); // one for all images: browsers have few contexts

/**
 * Draws `image` undistorted by `warp` into a 2D context, over all of its canvas.
 *
 * @param {HTMLCanvasElement} image
 * @param {PictureWarp} warp
 * @param {CanvasRenderingContext2D} context
 */
export function undistort(image, warp, context) {
  const { width, height } = context.canvas;
  context.clearRect(0, 0, width, height);
  context.drawImage(bench.value(image, warp, width, height), 0, 0);
}

/** @returns {Bench} */
function makeBench() {
  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl", { premultipliedAlpha: true, antialias: true });
  if (!gl) throw new Error("This browser cannot undistort images: it has no WebGL.");
  const program = gl.createProgram();
  const sources = { [gl.VERTEX_SHADER]: VERTEX, [gl.FRAGMENT_SHADER]: FRAGMENT };
  for (const [type, source] of Object.entries(sources)) {
    const shader = /** @type {WebGLShader} */ (gl.createShader(Number(type)));
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  gl.useProgram(program);
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  for (const [name, value] of [
    [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE],
    [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
    [gl.TEXTURE_MIN_FILTER, gl.LINEAR],
    [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
  ])
    gl.texParameteri(gl.TEXTURE_2D, name, value);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  for (const [i, name] of ["to", "from"].entries()) {
    const at = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, 2, gl.FLOAT, false, 16, 8 * i);
  }
  /** @type {PictureWarp | null} */
  let loaded = null;
  let corners = 0;
  return (image, warp, width, height) => {
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, { width, height });
    gl.viewport(0, 0, width, height);
    if (loaded !== warp) {
      const triangles = trianglesOf(warp);
      gl.bufferData(gl.ARRAY_BUFFER, triangles, gl.DYNAMIC_DRAW);
      loaded = warp;
      corners = triangles.length / 4;
    }
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, image);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.drawArrays(gl.TRIANGLES, 0, corners);
    return canvas;
  };
}

/**
 * Cells with a corner that the lens does not see are left out.
 *
 * @param {PictureWarp} warp
 */
function trianglesOf({ rows, columns, places }) {
  /** @type {number[]} */
  const vertices = [];
  for (let row = 0; row + 1 < rows; row++) {
    for (let column = 0; column + 1 < columns; column++) {
      const cell = [
        [0, 0],
        [0, 1],
        [1, 0],
        [1, 1],
      ].map(([down, right]) => {
        const [r, c] = [row + down, column + right];
        const at = 2 * (r * columns + c);
        return [c / (columns - 1), r / (rows - 1), places[at], places[at + 1]];
      });
      const corners = cell.map((corner) => corner.filter((each) => each !== null));
      if (corners.some((corner) => corner.length < 4)) continue;
      for (const corner of [0, 1, 2, 2, 1, 3]) vertices.push(...corners[corner]);
    }
  }
  return new Float32Array(vertices);
}

/**
 * The place of the image, as shares of its size, that is shown at a place of the undistorted one; or null.
 *
 * @param {PictureWarp} warp
 * @param {Vec2} place
 * @returns {Vec2 | null}
 */
export function straight(warp, place) {
  const [x, y] = place;
  if (x < 0 || y < 0 || x > 1 || y > 1) return null;
  const share = sourceOf(lensOf(warp), x, y);
  return share.every((each) => each >= 0 && each < 1) ? share : null;
}

/**
 * The grid of a warp, quick to search.
 *
 * @typedef {{
 *   rows: number, columns: number, places: Float64Array, nearby: Int32Array,
 * }} Lens  `nearby` are corners of the grid by the cell of the image that they are seen in
 */

const CELLS = 32; // of the image along each side
/** @type {WeakMap<PictureWarp, Lens>} */
const lenses = new WeakMap();

/**
 * @param {PictureWarp} warp
 * @returns {Lens}
 */
function lensOf(warp) {
  let lens = lenses.get(warp);
  if (!lens) {
    const { rows, columns } = warp;
    const places = Float64Array.from(warp.places, (place) => place ?? NaN);
    lens = { rows, columns, places, nearby: nearbyOf(places) };
    lenses.set(warp, lens);
  }
  return lens;
}

/** @param {number} share of the width or height of the image */
const cellAt = (share) => Math.max(0, Math.min(CELLS - 1, Math.floor(share * CELLS)));

/**
 * A corner of the grid in or near each cell of the image.
 *
 * @param {Float64Array} places
 */
function nearbyOf(places) {
  const nearby = new Int32Array(CELLS * CELLS).fill(-1);
  /** @type {number[]} */
  const cells = [];
  /**
   * @param {number} cell
   * @param {number} corner
   */
  const note = (cell, corner) => {
    if (nearby[cell] >= 0) return;
    nearby[cell] = corner;
    cells.push(cell);
  };
  for (let corner = 0; 2 * corner < places.length; corner++) {
    const [u, v] = [places[2 * corner], places[2 * corner + 1]];
    if (Number.isFinite(u + v)) note(cellAt(v) * CELLS + cellAt(u), corner);
  }
  for (const cell of cells) {
    // Cells without a corner have that of a neighbour.
    const [row, column] = [Math.floor(cell / CELLS), cell % CELLS];
    if (column > 0) note(cell - 1, nearby[cell]);
    if (column + 1 < CELLS) note(cell + 1, nearby[cell]);
    if (row > 0) note(cell - CELLS, nearby[cell]);
    if (row + 1 < CELLS) note(cell + CELLS, nearby[cell]);
  }
  return nearby;
}

/**
 * The same without a limit, from the nearest cell of the grid; not a number beside what the lens sees.
 *
 * @param {Lens} lens
 * @param {number} x
 * @param {number} y
 * @returns {Vec2}
 */
function sourceOf({ rows, columns, places }, x, y) {
  const [across, down] = [x * (columns - 1), y * (rows - 1)];
  const column = Math.max(0, Math.min(Math.floor(across), columns - 2));
  const row = Math.max(0, Math.min(Math.floor(down), rows - 2));
  const [u, v] = [across - column, down - row];
  const a = 2 * (row * columns + column);
  const c = a + 2 * columns;
  /** @param {0 | 1} axis */
  const share = (axis) =>
    (places[a + axis] * (1 - u) + places[a + 2 + axis] * u) * (1 - v) +
    (places[c + axis] * (1 - u) + places[c + 2 + axis] * u) * v;
  return [share(0), share(1)];
}

const STEPS = 8;
const SLOPE = 1e-3; // over which it is measured
const CLOSE = 1e-7; // of the image: less than a thousandth of a pixel

/**
 * The place of the undistorted image that shows a place of the image; the opposite of `straight`. Null
 * if the lens does not see it.
 *
 * @param {PictureWarp} warp
 * @param {Vec2} share
 * @returns {Vec2 | null}
 */
export function bent(warp, share) {
  const lens = lensOf(warp);
  const corner = lens.nearby[cellAt(share[1]) * CELLS + cellAt(share[0])];
  if (!(corner >= 0)) return null;
  let x = (corner % lens.columns) / (lens.columns - 1);
  let y = Math.floor(corner / lens.columns) / (lens.rows - 1);
  for (let step = 0; step < STEPS; step++) {
    const [u, v] = sourceOf(lens, x, y);
    const [du, dv] = [share[0] - u, share[1] - v];
    if (Math.abs(du) < CLOSE && Math.abs(dv) < CLOSE) break;
    const [uRight, vRight] = sourceOf(lens, x + SLOPE, y);
    const [uDown, vDown] = sourceOf(lens, x, y + SLOPE);
    const [a, b] = [(uRight - u) / SLOPE, (uDown - u) / SLOPE];
    const [c, d] = [(vRight - v) / SLOPE, (vDown - v) / SLOPE];
    const size = a * d - b * c;
    x += (d * du - b * dv) / size;
    y += (a * dv - c * du) / size;
  }
  return Number.isFinite(x) && Number.isFinite(y) ? [x, y] : null;
}
