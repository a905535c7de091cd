// Brightens the control under the pointer, and hides controls that cannot be used now.

import { active, isDefault, onChange } from "webviz/tools/registry.js";
import { effect, owned, signal, untracked } from "webviz/signals.js";
import * as viser from "webviz/viser_page.js";
import * as registry from "webviz/features/handles/registry.js";

/** @import {Part} from "webviz/features/handles/registry.js" */
/** @import {Color, MeshStandardMaterial} from "three" */

/** @type {Record<"over" | "pressed", number>} */
const SHINE = { over: 0.12, pressed: 0.28 }; // added in linear light; RViz adds 0.3 and 0.5
const AFTER_PLACING = -998;

/** @typedef {Part & {level: keyof typeof SHINE}} Lit */

const lit = signal(/** @type {Lit | null} */ (null));
/** The handle that is dragged. */
const activeHandle = signal(/** @type {string | null} */ (null));

export function install() {
  viser.eachFrame(AFTER_PLACING, hide);
  onChange(() => viser.requestRender());
  effect(() => {
    const part = lit.value;
    if (part) owned(untracked(() => shine(part)));
    viser.requestRender();
  });
}

/**
 * Lights a control `{id, control}` up, as the pointer is "over" it or has "pressed" it; null none.
 *
 * @param {Part | null} part
 * @param {keyof typeof SHINE} [level]
 */
export function light(part, level = "over") {
  const next = part && { id: part.id, control: part.control, level };
  if (keyOf(next) !== keyOf(lit.value)) lit.value = next;
}

/** @param {Lit | null} lit */
const keyOf = (lit) => lit && `${lit.id} ${lit.control} ${lit.level}`;

/**
 * Hides all other handles while one is dragged; null ends that.
 *
 * @param {string | null} id
 */
export function dim(id) {
  activeHandle.value = id;
  viser.requestRender();
}

/**
 * Brightens the materials of a control; returns what ends it.
 *
 * @param {Lit} lit
 */
function shine({ id, control, level }) {
  /** @type {Map<MeshStandardMaterial, {emissive?: Color, color?: Color}>} */
  const before = new Map();
  for (const path of registry.nodesOf(id).parts.get(control) ?? []) {
    viser.node(path)?.traverse(({ material }) => {
      for (const each of [material].flat()) if (each) brighten(each);
    });
  }
  return () => {
    for (const [material, { emissive, color }] of before) {
      if (emissive) material.emissive.copy(emissive);
      if (color) material.color.copy(color);
    }
  };

  /** @param {MeshStandardMaterial} material or another, which lacks some of its properties */
  function brighten(material) {
    if (before.has(material)) return;
    if (material.emissive) {
      before.set(material, { emissive: material.emissive.clone() });
      material.emissive.addScalar(SHINE[level]);
    } else if (material.color) {
      before.set(material, { color: material.color.clone() });
      material.color.multiplyScalar(1 + 2 * SHINE[level]);
    }
  }
}

function hide() {
  if (!active() || (isDefault() && activeHandle.value === null)) return;
  for (const [id, { controls }] of registry.all()) {
    for (const [number, paths] of registry.nodesOf(id).parts) {
      const isShown = controls[number]?.always || (isDefault() && id === activeHandle.value);
      for (const path of paths) {
        const object = viser.node(path);
        if (object && !isShown) object.visible = false;
      }
    }
  }
}
