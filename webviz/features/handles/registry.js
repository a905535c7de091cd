// The handles of the scene, and which of their parts is under a point of the window.

import constants from "webviz/constants.js";
import { listeners } from "webviz/listeners.js";
import { depthOf } from "webviz/scene/picking/lens.js";
import { pickAt } from "webviz/scene/picking/pick.js";
import { nodeNamed } from "webviz/scene/picking/things.js";
import { computed, signal } from "webviz/signals.js";
import { store, watch } from "webviz/stores.js";
import * as viser from "webviz/viser_page.js";
import { pathOf } from "webviz/scene/projection.js";

/** @import {Vector3} from "three" */
/** @import {SceneThing, ValuesOf, Vec2} from "webviz/types.js" */

/** @typedef {{groups: Map<string, string>, parts: Map<number, string[]>}} HandleNodes */

/** @typedef {{id: string, control: number}} Part */

const GROUP = /\|(m\d+)(?:\.([^|]*))?$/;
const PART = /^c(\d+)\//;

const changes = listeners();
const handles = store("handles");
const nodeCount = signal(0);
/** Nodes of each handle in the scene, found anew when handles or the number of nodes change. */
const index = computed(() => indexOf(all() && nodeCount.value ? Object.keys(viser.nodes()) : []));

export function install() {
  watch("handles", changes.tell);
}

/**
 * All handles by id.
 *
 * @returns {ValuesOf<"handles">}
 */
export const all = () => handles.all();

/** Calls a listener when handles change. */
export const onChange = changes.on;

/**
 * The handle and the number of the control that a node belongs to, or null: `{id, control}`.
 *
 * @param {{group: string, key: string}} node
 * @returns {Part | null}
 */
function partOf({ group, key }) {
  const id = groupOf(group)?.id;
  const part = PART.exec(key);
  return id && all().has(id) && part ? { id, control: Number(part[1]) } : null;
}

/**
 * The id of the handle of a group, and what follows its key, or null: `{id, suffix}`.
 *
 * @param {string} group
 */
export function groupOf(group) {
  const match = GROUP.exec(group);
  return (
    match && { id: `${group.slice(0, group.indexOf("/"))}/${match[1]}`, suffix: match[2] ?? "" }
  );
}

/**
 * The control under a point of the window, or null: `{id, control, point}`, `point` in three.js'
 * coordinates. What lies in front of it hides it.
 *
 * @param {Vec2} xy
 * @returns {(Part & {point: Vector3}) | null}
 */
export function controlAt(xy) {
  if (!all().size) return null;
  const hit = pickAt(xy, isUsable);
  if (!hit) return null;
  // Only now, since it looks at every point of the scene.
  const other = pickAt(xy, (thing) => !isUsable(thing), 0);
  if (other && depthOf(other.point) < depthOf(hit.point)) return null;
  const part = partOf(hit);
  return part && { ...part, point: hit.point };
}

/** @param {SceneThing} thing */
function isUsable({ node }) {
  const part = partOf(node);
  // The handle may have lost the control, whose nodes go a moment later.
  const control = part && controlOf(part);
  return control !== null && control.mode !== "none";
}

/**
 * A control by its handle and number.
 *
 * @param {Part} part
 */
export const controlOf = ({ id, control }) => all().get(id)?.controls[control] ?? null;

/**
 * The names of viser's nodes of a handle: `{groups, parts}`, its groups by what follows the key,
 * "" for the first, and the nodes of each control.
 *
 * @param {string} id
 * @returns {HandleNodes}
 */
export function nodesOf(id) {
  nodeCount.value = Object.keys(viser.nodes()).length;
  return index.value.get(id) ?? { groups: new Map(), parts: new Map() };
}

/** @param {string[]} names */
function indexOf(names) {
  /** @type {Map<string, HandleNodes>} */
  const nodes = new Map();
  for (const name of names) {
    const node = name.startsWith(`${constants.ROOT}/`) ? nodeNamed(name) : null;
    const place = node && groupOf(node.group);
    if (!place || name !== node.path) continue;
    const { groups, parts } = nodes.get(place.id) ?? { groups: new Map(), parts: new Map() };
    nodes.set(place.id, { groups, parts });
    groups.set(place.suffix, pathOf(node.group));
    const part = PART.exec(node.key)?.[1];
    if (part) parts.set(Number(part), [...(parts.get(Number(part)) ?? []), name]);
  }
  return nodes;
}
