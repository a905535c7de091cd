// Picking under a point of the window, or in a box of it: the node, and which of its items.

import { casterAt } from "webviz/scene/rays.js";
import * as viser from "webviz/viser_page.js";
import { depthOf, lensOf, onCanvasAt, pixelAt, project } from "webviz/scene/picking/lens.js";
import { lineAt, lineCount, lineOf } from "webviz/scene/picking/lines.js";
import { colorOf, pointAt, pointOf, pointsIn } from "webviz/scene/picking/points.js";
import { isTextIn, textAt } from "webviz/scene/picking/texts.js";
import { isTile, things } from "webviz/scene/picking/things.js";

/** @import {Raycaster, Vector3} from "three" */
/** @import {Box, Picked, SceneObject, SceneText, SceneThing, Vec2, Vec3} from "webviz/types.js" */

/**
 * The hit of a thing; `off` is how far beside it, in pixels, `layer` that of a picture.
 *
 * @typedef {{number: number | null, off: number, depth: number, point?: Vector3, layer?: number}} Under
 * @typedef {SceneThing & Under & {rank: number}} Hit
 */

const NEAR_PX = 4; // what the pointer means although it is not quite on it
const PLANE_PX = 1; // what is as close together in depth lies in one plane

/**
 * The thing under a point of the window, or null: `{group, key, number, at, color}` as the server knows
 * it, `point` in three.js' coordinates, and `object`, `name`, `ordinal` and `item` of what draws it.
 *
 * Only things that are wanted count, and those within `reach` pixels. What the pointer is on comes
 * first, the nearest of several; then lines and points next to it. A picture, such as a map, comes
 * last of what is not behind it.
 *
 * @param {Vec2} xy
 * @param {(thing: SceneThing) => boolean} [isWanted]
 * @param {number} [reach]
 * @returns {Picked | null}
 */
export function pickAt(xy, isWanted = () => true, reach = NEAR_PX) {
  const at = onCanvasAt(xy);
  const caster = casterAt(xy);
  /** @type {(Hit | null)[]} the nearest of each kind */
  let [on, near, flat] = [null, null, null];
  for (const thing of things()) {
    const hit = isWanted(thing) ? hitOf(thing, at, caster, reach) : null;
    if (!hit) continue;
    const candidate = { ...thing, ...hit, rank: rankOf(thing.object) };
    if (candidate.layer !== undefined) flat = isOver(candidate, flat) ? candidate : flat;
    else if (candidate.off === 0) on = isNearer(candidate, on) ? candidate : on;
    else if (!near || candidate.off < near.off) near = candidate;
  }
  const floor = flat && !(on && on.depth < flat.depth) ? flat : null;
  const best = floor ? (near && near.depth < floor.depth ? near : floor) : (on ?? near);
  return best && described(best, caster);
}

/**
 * All wanted things whose middle is in a box of the window, the first `most`, and how many there are.
 *
 * @param {Box} box
 * @param {number} most
 * @param {(thing: SceneThing) => boolean} [isWanted]
 */
export function pickIn({ left, top, right, bottom }, most, isWanted = () => true) {
  const { left: x, top: y } = viser.canvas().getBoundingClientRect();
  const box = { left: left - x, top: top - y, right: right - x, bottom: bottom - y };
  /** @type {Picked[]} */
  const picks = [];
  let total = 0;
  for (const thing of things().filter(isWanted)) {
    /** @param {number | null} number */
    const take = (number) => {
      if (picks.length < most) picks.push(described({ ...thing, number }));
      total += 1;
    };
    if (!isTile(thing.name)) itemsIn(thing.object, box, take);
  }
  return { picks, total };
}

/**
 * @param {SceneThing} thing
 * @param {Vec2} at
 * @param {Raycaster} caster
 * @param {number} reach
 */
function hitOf({ object, name }, at, caster, reach) {
  if (object.isText) return textAt(object, at);
  if (object.isPoints) return pointAt(object, at, reach);
  if (object.isLineSegments2) return lineAt(object, at, reach);
  const [hit] = caster.intersectObject(object, false).sort((a, b) => a.distance - b.distance);
  if (!hit) return null;
  // Not the point of the hit, which is wrong for instanced meshes.
  const point = caster.ray.at(hit.distance, viser.camera().position.clone());
  const place = { number: hit.instanceId ?? null, off: 0, depth: depthOf(point), point };
  if (!isTile(name)) return place;
  // Farther than what lies on it.
  return {
    ...place,
    depth: place.depth + PLANE_PX * pixelAt(place.depth),
    layer: object.renderOrder,
  };
}

// Of what lies in one plane, a point is meant rather than a line, and that rather than a surface.
/**
 * @param {Hit} a
 * @param {Hit | null} b
 * @returns {boolean}
 */
function isNearer(a, b) {
  if (b && isLevel(a, b) && a.rank !== b.rank) return a.rank > b.rank;
  return !b || a.depth < b.depth;
}

/**
 * @param {Hit} a
 * @param {Hit} b
 */
const isLevel = (a, b) => Math.abs(a.depth - b.depth) < PLANE_PX * pixelAt(b.depth);

/**
 * @param {SceneObject | SceneText} object
 * @returns {number}
 */
const rankOf = ({ isText, isPoints, isLineSegments2 }) =>
  isText || isPoints ? 2 : isLineSegments2 ? 1 : 0;

// Pictures of one plane lie over each other by their layer.
/**
 * @param {Hit} a
 * @param {Hit | null} b
 * @returns {boolean}
 */
function isOver(a, b) {
  if (b && isLevel(a, b)) return (a.layer ?? 0) >= (b.layer ?? 0);
  return isNearer(a, b);
}

/**
 * A part of an object as a pick; `number` is that of the object.
 *
 * @param {SceneThing & {number: number | null, depth?: number, point?: Vector3}} target
 * @param {Raycaster} [caster]
 * @returns {Picked}
 */
export function described(target, caster) {
  const { object, name, ordinal, number, depth } = target;
  const { group, key, path, first } = target.node;
  const thing = { group, key, path, name, ordinal, object, number, color: null };
  const local = anchorOf(object, number);
  if (object.isText) return { ...thing, item: number, at: local, local, point: object.place };
  /** @param {number[]} xyz */
  const inThree = (xyz) =>
    viser.camera().position.clone().fromArray(xyz).applyMatrix4(object.matrixWorld);
  if (object.isPoints) {
    const item = Number(number);
    const more = { number: item + first, item, color: colorOf(object, item) };
    return { ...thing, ...more, at: local, local, point: inThree(local) };
  }
  const point =
    target.point ?? (depth !== undefined && caster ? onRay(depth, caster) : inThree(local));
  if (number !== null) return { ...thing, item: number, at: local, local, point };
  // In the coordinates of the node, which has several objects.
  const whole = viser.node(path) ?? object;
  const at = point.clone().applyMatrix4(whole.matrixWorld.clone().invert()).toArray();
  return { ...thing, item: null, at, local, point };
}

// The point of a line next to the pointer.
/**
 * @param {number} depth
 * @param {Raycaster} caster
 */
function onRay(depth, caster) {
  const forward = caster.ray.direction
    .clone()
    .transformDirection(viser.camera().matrixWorldInverse);
  const start = depthOf(caster.ray.origin);
  return caster.ray.at((depth - start) / -forward.z, viser.camera().position.clone());
}

/**
 * Return where an item is in the coordinates of its object; of a mesh, its middle.
 *
 * @param {SceneObject | SceneText} object
 * @param {number | null} number
 * @returns {Vec3 | []} empty for an item that is gone
 */
export function anchorOf(object, number) {
  if (object.isText) return object.local;
  if (object.isPoints) return pointOf(object, Number(number));
  if (object.isLineSegments2) return lineOf(object, Number(number))[0] ?? [];
  if (number === null) {
    if (!object.geometry.boundingBox) object.geometry.computeBoundingBox();
    const { min, max } = object.geometry.boundingBox;
    return [(min.x + max.x) / 2, (min.y + max.y) / 2, (min.z + max.z) / 2];
  }
  if (!object.getMatrixAt || number >= (object.instancesCount ?? Infinity)) return [];
  const { elements } = object.getMatrixAt(number, object.matrixWorld.clone());
  return [elements[12], elements[13], elements[14]];
}

// Lines count when they are in the box as a whole: else a box on a grid would take most of it.
/**
 * @param {SceneObject | SceneText} object
 * @param {Box} box
 * @param {(number: number | null) => unknown} take
 */
function itemsIn(object, box, take) {
  if (object.isPoints) return pointsIn(object, box, take);
  if (object.isText) return isTextIn(object, box) ? take(object.number) : undefined;
  const lens = lensOf(object);
  /** @param {Vec3 | []} xyz */
  const isIn = (xyz) => {
    const place = xyz.length === 3 ? project(lens, xyz) : null;
    if (!place) return false;
    const [x, y] = place;
    return x >= box.left && x <= box.right && y >= box.top && y <= box.bottom;
  };
  if (object.isLineSegments2) {
    for (let i = 0; i < lineCount(object); i++) if (lineOf(object, i).every(isIn)) take(i);
  } else if (object.instancesCount === undefined) {
    if (isIn(anchorOf(object, null))) take(null);
  } else {
    for (let i = 0; i < object.instancesCount; i++) if (isIn(anchorOf(object, i))) take(i);
  }
}
