// The scene as another camera sees it: drawn on the page's own canvas before what the page shows, in
// the same frame, and copied from there. So colours, depth and smoothing are those of the page.

import constants from "webviz/constants.js";
import { pathOf } from "webviz/scene/projection.js";
import { toThree } from "webviz/scene/fixed_frame.js";
import { scheme } from "webviz/scene/scheme.js";
import { computed } from "webviz/signals.js";
import * as viser from "webviz/viser_page.js";

/** @import {PerspectiveCamera, WebGLRenderer} from "three" */
/** @import {SceneObject, Vec3, Wxyz} from "webviz/types.js" */

const { ROOT } = constants;
const NEAR = 0.01; // metres, as RViz

/**
 * A camera: `position` and `wxyz` place it in the fixed frame: x to the right, y down, z ahead. `edges` are
 * left, right, top and bottom of what it sees 1 m ahead; of one without perspective, what it sees at the
 * distance `flat` as well. Displays with an id in `hidden` are left out.
 *
 * @typedef {{
 *   position: Vec3, wxyz: Wxyz, edges: number[], far: number, hidden: string[], flat?: number,
 * }} Sight
 * @typedef {PerspectiveCamera & Pick<Sight, "edges"> & {flat: number}} Eye
 */

const ownEye = computed(makeEye);

/**
 * Calls `draw` before each frame of the page, until the function is called that this returns.
 *
 * @param {() => void} draw
 * @returns {() => void}
 */
export const eachPicture = (draw) => viser.eachFrame(0, draw);

/**
 * Fills a 2D context with what is behind the scene: the colour of the config, or that of the theme.
 *
 * @param {CanvasRenderingContext2D} context
 */
export function drawBackground(context) {
  const { width, height } = context.canvas;
  const { enabled, colorMap } = viser.backgroundMaterial().uniforms;
  if (enabled.value && colorMap.value)
    return context.drawImage(colorMap.value.image, 0, 0, width, height);
  context.fillStyle = `rgb(${scheme().background.join()})`;
  context.fillRect(0, 0, width, height);
}

/**
 * Draws the scene into a 2D context, `width` x `height` pixels large, transparent where it is empty.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {number} width
 * @param {number} height
 * @param {Sight} sight
 */
export function drawSecond(context, width, height, sight) {
  const { position, wxyz, edges, far, hidden, flat = 0 } = sight;
  const gl = viser.gl();
  const canvas = gl.domElement;
  const shrink = Math.min(1, canvas.width / width, canvas.height / height);
  const [wide, tall] = [Math.floor(width * shrink), Math.floor(height * shrink)];
  if (!wide || !tall) return;
  const eye = ownEye.value;
  place(eye, position, wxyz);
  Object.assign(eye, { edges, far, flat });
  eye.updateProjectionMatrix();
  const undo = [hide(hidden), scalePoints((2 * tall) / (edges[2] - edges[3])), background(gl)];
  const dpr = gl.getPixelRatio();
  try {
    gl.setViewport(0, 0, wide / dpr, tall / dpr);
    gl.setScissor(0, 0, wide / dpr, tall / dpr);
    gl.setScissorTest(true); // else all of the canvas is cleared
    gl.render(viser.scene(), eye);
    context.drawImage(canvas, 0, canvas.height - tall, wide, tall, 0, 0, width, height);
  } finally {
    gl.setScissorTest(false);
    gl.setViewport(0, 0, canvas.width / dpr, canvas.height / dpr);
    for (const each of undo) each();
  }
}

/** @returns {Eye} */
function makeEye() {
  const Camera = /** @type {typeof PerspectiveCamera} */ (viser.camera().constructor);
  const camera = Object.assign(new Camera(), { near: NEAR, edges: [-1, 1, 1, -1], flat: 0 });
  camera.matrixAutoUpdate = false;
  camera.updateProjectionMatrix = function () {
    const { edges, far, flat, coordinateSystem, reversedDepth } = this;
    const [depth, near] = flat ? [flat, flat / 100] : [NEAR, NEAR];
    const [left, right, top, bottom] = edges.map((edge) => edge * depth);
    const make = flat ? "makeOrthographic" : "makePerspective";
    this.projectionMatrix[make](
      left,
      right,
      top,
      bottom,
      near,
      far,
      coordinateSystem,
      reversedDepth,
    );
    this.projectionMatrixInverse.copy(this.projectionMatrix).invert();
  };
  return camera;
}

/**
 * @param {Eye} eye
 * @param {Vec3} position
 * @param {Wxyz} wxyz
 */
function place(eye, position, [w, x, y, z]) {
  const at = eye.position.clone().fromArray(position);
  eye.matrix.compose(at, eye.quaternion.clone().set(x, y, z, w), eye.scale.clone().set(1, -1, -1));
  eye.matrix.premultiply(toThree());
  eye.matrixWorldNeedsUpdate = true;
  eye.updateMatrixWorld();
}

/** @param {string[]} hidden */
function hide(hidden) {
  const prefixes = hidden.map((id) => pathOf(`${id}/`));
  const names = prefixes.length
    ? Object.keys(viser.nodes()).filter((name) => prefixes.some((one) => name.startsWith(one)))
    : [];
  const nodes = names.flatMap((name) => viser.node(name) ?? []);
  // Besides displays, what the page draws for itself: handles, marks, and the like.
  const world = viser.node(ROOT);
  const labels = viser.scene().children.find((child) => child.children.some(lettersOf));
  for (const child of viser.scene().children) {
    if (!child.isLight && child !== labels && !contains(child, world ?? null)) nodes.push(child);
  }
  const visibleNodes = nodes.filter((node) => node.visible);
  const undo = names.length && labels ? hideLabels(labels, names) : () => {};
  for (const node of visibleNodes) node.visible = false;
  return () => {
    for (const node of visibleNodes) node.visible = true;
    undo();
  };
}

/** @param {SceneObject} mesh */
const lettersOf = (mesh) => mesh.material?.uniforms?.uLabelData;

// viser draws all labels at once, by a table of where each is and whether it can be seen; their nodes
// have no objects.
/**
 * @param {SceneObject} labels
 * @param {string[]} names
 */
function hideLabels(labels, names) {
  const table = labels.children.map(lettersOf).find(Boolean).value;
  const { data } = table.image;
  /** @param {...number} xyz */
  const key = (...xyz) => xyz.map((length) => Math.round(length * 1e4)).join();
  const places = new Set();
  for (const name of names) {
    const outer = viser.node(name.slice(0, name.lastIndexOf("/")));
    const at = viser.node(name) ? null : viser.positionOf(name);
    if (!outer || !at) continue;
    places.add(
      key(
        ...viser.camera().position.clone().fromArray(at).applyMatrix4(outer.matrixWorld).toArray(),
      ),
    );
  }
  /** @type {any[]} */
  const off = [];
  for (let i = 0; i < data.length; i += 4) {
    if (data[i + 3] && places.has(key(data[i], data[i + 1], data[i + 2]))) off.push(i + 3);
  }
  /** @param {number} value */
  const put = (value) => {
    for (const i of off) data[i] = value;
    if (off.length) table.needsUpdate = true;
  };
  put(0);
  return () => put(1);
}

/**
 * @param {SceneObject} object
 * @param {SceneObject | null} inner
 * @returns {boolean}
 */
function contains(object, inner) {
  for (let each = inner; each; each = each.parent) if (each === object) return true;
  return false;
}

// viser sizes points for its own camera, in pixels at 1 m.
/** @param {number} pixels of twice a metre there */
function scalePoints(pixels) {
  const own = viser.camera();
  const ownTall = viser.gl().domElement.height;
  const factor = (pixels * Math.tan((own.fov * Math.PI) / 360)) / ownTall;
  /** @type {any[]} */
  const scales = [];
  viser.scene().traverse(({ isPoints, material }) => {
    if (isPoints && material.uniforms?.scale) scales.push(material.uniforms.scale);
  });
  const before = scales.map((scale) => scale.value);
  for (const scale of scales) scale.value *= factor;
  return () => scales.forEach((scale, i) => (scale.value = before[i]));
}

/** @param {WebGLRenderer} gl */
function background(gl) {
  const { enabled } = viser.backgroundMaterial().uniforms;
  const [was, alpha] = [enabled.value, gl.getClearAlpha()];
  enabled.value = false;
  gl.setClearAlpha(0);
  return () => {
    enabled.value = was;
    gl.setClearAlpha(alpha);
  };
}
