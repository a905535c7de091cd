// Picking texts. viser draws all of them in a few meshes, which know where each is and how large, but
// not of which node: that is the one at the same place.

import { boxes } from "webviz/scene/labels.js";
import * as viser from "webviz/viser_page.js";
import { depthOf, lensOf, project } from "webviz/scene/picking/lens.js";

/** @import {Vector3} from "three" */
/** @import {Box, SceneText, Vec2} from "webviz/types.js" */

const TEXT = /^(.*)\/(\d+)$/; // the name of a text: that of its node, and its number

/**
 * All texts that are shown: `{object, name}`, `name` as viser has it, and `object` stands for what a
 * mesh is of others: `{isText, number, local, place, rect}`. `number` counts the texts of a node,
 * `local` is in the coordinates of that, `place` in three.js', and `rect` around it, `[left, bottom,
 * width, height]` in metres along the screen.
 *
 * @returns {{object: SceneText, name: string}[]}
 */
export function texts() {
  const rects = rectangles();
  /** @type {ReturnType<typeof texts>} */
  const items = [];
  for (const name of rects.size ? Object.keys(viser.nodes()) : []) {
    const [, outer, number] = TEXT.exec(name) ?? [];
    const local = number && viser.positionOf(name);
    const node = local && viser.node(outer);
    if (!node) continue;
    const place = node.position.clone().fromArray(local).applyMatrix4(node.matrixWorld);
    const rect = rects.get(keyOf(place));
    if (rect)
      items.push({ object: { isText: true, number: Number(number), local, place, rect }, name });
  }
  return items;
}

/** @param {{x: number, y: number, z: number}} place */
const keyOf = ({ x, y, z }) => [x, y, z].map(Math.fround).join();

// Of all texts that are shown, by where they are.
function rectangles() {
  /** @type {Map<string, SceneText["rect"]>} */
  const rects = new Map();
  for (const { geometry, material } of boxes()) {
    const { aLabelIndex: index, aRect: rect, aParams } = geometry.attributes;
    const { data } = material.uniforms.uLabelData.value.image;
    for (let i = 0; i < geometry.instanceCount; i++) {
      const at = 4 * index.getX(i);
      const scale = data[at + 3] ? aParams.getY(i) : 0;
      const [x, y, z] = data.subarray(at, at + 3);
      const [left, bottom] = [rect.getX(i) * scale, rect.getY(i) * scale];
      const size = [rect.getZ(i) * scale, rect.getW(i) * scale];
      if (scale) rects.set(keyOf({ x, y, z }), [left, bottom, size[0], size[1]]);
    }
  }
  return rects;
}

/**
 * The corners of the rectangle around a text, in three.js' coordinates.
 *
 * @param {SceneText} text
 */
export function cornersOf({ place, rect: [left, bottom, wide, tall] }) {
  const { elements: m } = viser.camera().matrixWorld;
  const [right, up] = [0, 4].map((at) => place.clone().set(m[at], m[at + 1], m[at + 2]));
  return [
    [0, 0],
    [1, 0],
    [1, 1],
    [0, 1],
  ].map(([x, y]) =>
    place
      .clone()
      .addScaledVector(right, left + x * wide)
      .addScaledVector(up, bottom + y * tall),
  );
}

/**
 * The text under a place of the canvas, or null: `{number, depth, off, point}`.
 *
 * @param {SceneText} text
 * @param {Vec2} at
 */
export function textAt(text, [atX, atY]) {
  const ends = cornersOf(text).map((corner) => onCanvas(corner));
  const [lower, , upper] = ends;
  if (!lower || !upper) return null;
  const isOn = atX >= lower[0] && atX <= upper[0] && atY <= lower[1] && atY >= upper[1];
  const { number, place } = text;
  return isOn ? { number, depth: depthOf(place), off: 0, point: place } : null;
}

/**
 * True if the middle of a text is in a box of the canvas.
 *
 * @param {SceneText} text
 * @param {Box} box
 */
export function isTextIn({ place }, { left, top, right, bottom }) {
  const at = onCanvas(place);
  return at !== null && at[0] >= left && at[0] <= right && at[1] >= top && at[1] <= bottom;
}

/**
 * @param {Vector3} point
 * @returns {Vec2 | null}
 */
const onCanvas = (point) =>
  project(lensOf({ matrixWorld: viser.camera().matrixWorld.clone().identity() }), point.toArray());
