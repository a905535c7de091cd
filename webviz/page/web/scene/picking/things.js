// Objects that are drawn in the scene, with the names of the nodes that they belong to.

import constants from "webviz/constants.js";
import * as viser from "webviz/viser_page.js";
import { texts } from "webviz/scene/picking/texts.js";

/** @import {NodePart, SceneObject, SceneThing} from "webviz/types.js" */

const { ROOT, TILE_PREFIX, PART_PREFIX, BLOCK_PREFIX, POINTS_PER_PART } = constants;

/**
 * All that displays draw and that can be seen: `{object, name, node, ordinal}`; `object` is of three.js
 * or a text, see `texts`, `name` is that of viser's node, see `nodeNamed`, and `ordinal` counts the
 * objects of one.
 */
export function things() {
  const names = new Map(Object.entries(viser.nodes()).map(([name, node]) => [node, name]));
  /** @type {Map<string, number>} */
  const counts = new Map();
  /** @type {SceneThing[]} */
  const items = [];
  const root = viser.node(ROOT);
  if (root) visit(root, ROOT);
  for (const text of texts()) {
    const node = nodeNamed(text.name);
    if (node) items.push({ ...text, node, ordinal: 0 });
  }
  return items;

  /**
   * @param {SceneObject} object
   * @param {string} outer
   */
  function visit(object, outer) {
    if (!object.visible) return;
    const name = names.get(object) ?? outer;
    const node = isPickable(object) ? nodeNamed(name) : null;
    if (node) {
      const ordinal = counts.get(name) ?? 0;
      counts.set(name, ordinal + 1);
      items.push({ object, name, node, ordinal });
    }
    for (const child of object.children) visit(child, name);
  }
}

/** Finds among `things` the object of a node by its name and ordinal; null for none. */
export function finder() {
  const objects = new Map(
    things().map(({ object, name, ordinal }) => [`${ordinal} ${name}`, object]),
  );
  return (/** @type {string} */ name, /** @type {number} */ ordinal) =>
    objects.get(`${ordinal} ${name}`) ?? null;
}

// Without a `raycast` of its own an object is a second pass of another, as viser draws lines.
/**
 * @param {SceneObject} object
 * @returns {boolean}
 */
const isPickable = (object) =>
  Boolean(object.geometry) &&
  Boolean(object.isPoints || (object.isMesh && object.raycast.length > 0));

/** @param {string} name */
export const isTile = (name) => name.includes(`/${TILE_PREFIX}`);

/**
 * The node of the viewer that a node of viser is or is part of: `{group, key, path, first}`; `first` is
 * the number of its first point. Null for what is not of a display.
 *
 * @param {string} name
 * @returns {NodePart | null}
 */
export function nodeNamed(name) {
  const [, , group, key, part = ""] = name.split("/");
  if (group === undefined || key === undefined) return null;
  const prefix = [PART_PREFIX, BLOCK_PREFIX].find((each) => part.startsWith(each));
  const before = prefix ? Number(part.slice(prefix.length)) : 0;
  try {
    const path = `${ROOT}/${group}/${key}`;
    return { group: text(group), key: text(key), path, first: before * POINTS_PER_PART };
  } catch {
    return null; // no name that can be written in Unicode
  }
}

/** @param {string} segment */
const text = (segment) => (segment === "%" ? "" : decodeURIComponent(segment));
