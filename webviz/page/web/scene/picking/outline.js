// The outline of what was picked, where it is now.

import * as viser from "webviz/viser_page.js";
import { anchorOf } from "webviz/scene/picking/pick.js";
import { lineOf } from "webviz/scene/picking/lines.js";
import { cornersOf } from "webviz/scene/picking/texts.js";

/** @import {Box3, Matrix4, Vector3} from "three" */
/** @import {Outline, Picked, SceneObject, SceneText, Shape, Vec3} from "webviz/types.js" */

// The corners of a box by the bits of their numbers, and which of them its edges join.
const CORNERS = [0, 1, 2, 3, 4, 5, 6, 7];
const AROUND = [
  [0, 1],
  [1, 2],
  [2, 3],
  [3, 0],
];
const EDGES = CORNERS.flatMap((from) =>
  [1, 2, 4].filter((bit) => !(from & bit)).map((bit) => [from, from | bit]),
);

/**
 * The outline around a pick, whose object `find` finds (see `finder`), and which `moves` and
 * stays what it is, or not: `{points, edges, isOld}`, `points` in three.js' coordinates; a point of
 * a cloud has no edges. `isOld` says that something else is drawn there now, and the outline is where
 * it was. Null while its node is not shown.
 *
 * @param {Picked} pick
 * @param {(name: string, ordinal: number) => SceneObject | SceneText | null} find
 * @param {boolean} moves
 * @returns {Outline | null}
 */
export function outlineOf(pick, find, moves) {
  const object = find(pick.name, pick.ordinal);
  if (!object) return null;
  const isOld = pick.item !== null && !isSame(pick, object, moves);
  if (!isOld) pick.outline = make(pick, object);
  return pick.outline ? { ...pick.outline, isOld } : null;
}

// An object that does not move is known by where it is.
/**
 * @param {Picked} pick
 * @param {SceneObject | SceneText} object
 * @param {boolean} moves
 */
function isSame(pick, object, moves) {
  const at = anchorOf(object, pick.item);
  if (moves) return at.length > 0;
  return at.length > 0 && at.every((number, axis) => number === pick.local[axis]);
}

/**
 * @param {Picked} pick
 * @param {SceneObject | SceneText} object
 */
function make(pick, object) {
  /**
   * @param {number[]} xyz
   * @param {Matrix4} matrix
   */
  const place = (xyz, matrix) => vector(xyz).applyMatrix4(matrix);
  if (object.isText) return { points: cornersOf(object), edges: AROUND };
  if (object.isPoints) return { points: [place(pick.local, object.matrixWorld)], edges: [] };
  if (object.isLineSegments2) {
    const ends = lineOf(object, Number(pick.item)).map((xyz) => place(xyz, object.matrixWorld));
    return { points: ends, edges: [[0, 1]] };
  }
  if (object.material?.map && object.geometry.parameters?.width) return cell(pick, object);
  const whole = viser.node(pick.path);
  if (pick.item === null || !object.getMatrixAt) return whole ? boxOf(whole) : null;
  const matrix = object.getMatrixAt(pick.item, object.matrixWorld.clone());
  return box(boundsOf(object), matrix.premultiply(object.matrixWorld));
}

/**
 * @param {SceneObject} mesh
 * @returns {Box3}
 */
function boundsOf({ geometry }) {
  if (!geometry.boundingBox) geometry.computeBoundingBox();
  return geometry.boundingBox;
}

/**
 * @param {{min: Vector3, max: Vector3}} bounds
 * @param {Matrix4} matrix
 */
function box({ min, max }, matrix) {
  const points = CORNERS.map((corner) => {
    /** @param {number} bit */
    const side = (bit) => (corner & bit ? max : min);
    return vector([side(1).x, side(2).y, side(4).z]).applyMatrix4(matrix);
  });
  return { points, edges: EDGES };
}

// Around all meshes of a node, along its axes.
/** @param {SceneObject} node */
function boxOf(node) {
  const back = node.matrixWorld.clone().invert();
  /** @type {Box3 | null} */
  let whole = null;
  node.traverse((object) => {
    if (!object.isMesh || !object.raycast.length) return;
    const bounds = boundsOf(object).clone();
    bounds.applyMatrix4(back.clone().multiply(object.matrixWorld));
    whole = whole ? whole.union(bounds) : bounds;
  });
  return whole && box(whole, node.matrixWorld);
}

// Of a picture, the cell that was hit.
/**
 * @param {Picked} pick
 * @param {SceneObject} object
 */
function cell(pick, object) {
  const { width, height } = object.geometry.parameters;
  const { width: columns, height: rows } = object.material.map.image;
  const steps = [width / columns, height / rows];
  const whole = /** @type {SceneObject} */ (viser.node(pick.path));
  const hit = vector(pick.at).applyMatrix4(whole.matrixWorld);
  const { x, y } = hit.applyMatrix4(object.matrixWorld.clone().invert());
  const start = [x, y].map(
    (place, axis) => Math.floor(place / steps[axis] + shift(axis)) - shift(axis),
  );
  const points = [
    [0, 0],
    [1, 0],
    [1, 1],
    [0, 1],
  ].map(([right, up]) => {
    /** @type {Vec3} */
    const corner = [(start[0] + right) * steps[0], (start[1] + up) * steps[1], 0];
    return vector(corner).applyMatrix4(object.matrixWorld);
  });
  return { points, edges: AROUND };

  // The picture is around its middle, which is in a cell if their number is odd.
  /** @param {number} axis */
  function shift(axis) {
    return ([columns, rows][axis] % 2) / 2;
  }
}

/**
 * @param {number[]} xyz
 * @returns {Vector3}
 */
const vector = (xyz) => viser.camera().position.clone().fromArray(xyz);
