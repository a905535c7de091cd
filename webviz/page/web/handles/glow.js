// Brightens the control under the pointer, and hides controls that cannot be used now.

import { active, isDefault, onChange } from "webviz/tools/registry.js";
import * as viser from "webviz/viser_page.js";
import * as known from "webviz/handles/known.js";

/** @import {Part} from "webviz/handles/known.js" */
/** @import {Color, MeshStandardMaterial} from "three" */

/** @type {Record<"over" | "pressed", number>} */
const SHINE = { over: 0.12, pressed: 0.28 }; // added in linear light; RViz adds 0.3 and 0.5
const AFTER_PLACING = -998;

/** @type {Map<MeshStandardMaterial, {emissive?: Color, color?: Color}>} */
const shining = new Map(); // materials, and what they were
/** @type {string | null} */
let lit = null;
/** @type {string | null} */
let held = null; // the handle that is dragged

export function install() {
  viser.eachFrame(AFTER_PLACING, hide);
  onChange(() => viser.requestRender());
}

/**
 * Lights a control `{id, control}` up, as the pointer is "over" it or has "pressed" it; null none.
 *
 * @param {Part | null} part
 * @param {keyof typeof SHINE} [level]
 */
export function light(part, level = "over") {
  const name = part && `${part.id} ${part.control} ${level}`;
  if (name === lit) return;
  lit = name;
  for (const [material, { emissive, color }] of shining) {
    if (emissive) material.emissive.copy(emissive);
    if (color) material.color.copy(color);
  }
  shining.clear();
  for (const path of part ? (known.nodesOf(part.id).parts.get(part.control) ?? []) : []) {
    viser.node(path)?.traverse(({ material }) => {
      for (const each of [material].flat()) if (each) shine(each, SHINE[level]);
    });
  }
  viser.requestRender();
}

/**
 * Hides all other handles while one is dragged; null ends that.
 *
 * @param {string | null} id
 */
export function dim(id) {
  held = id;
  viser.requestRender();
}

/**
 * @param {MeshStandardMaterial} material or another, which lacks some of its properties
 * @param {number} amount
 */
function shine(material, amount) {
  if (shining.has(material)) return;
  if (material.emissive) {
    shining.set(material, { emissive: material.emissive.clone() });
    material.emissive.addScalar(amount);
  } else if (material.color) {
    shining.set(material, { color: material.color.clone() });
    material.color.multiplyScalar(1 + 2 * amount);
  }
}

function hide() {
  if (!active() || (isDefault() && held === null)) return;
  for (const [id, { controls }] of known.all()) {
    for (const [number, paths] of known.nodesOf(id).parts) {
      const isShown = controls[number]?.always || (isDefault() && id === held);
      for (const path of paths) {
        const object = viser.node(path);
        if (object && !isShown) object.visible = false;
      }
    }
  }
}
