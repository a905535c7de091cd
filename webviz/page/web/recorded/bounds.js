// The box around what displays draw, as the page has it.

import { toThree } from "webviz/scene/fixed_frame.js";
import constants from "webviz/constants.js";
import * as viser from "webviz/viser_page.js";

/** @import {Vec3} from "webviz/types.js" */

const AXES = [0, 1, 2];

/**
 * The box in the fixed frame around what displays with these ids draw, null around nothing.
 *
 * @param {string[]} displays
 * @returns {{low: Vec3, high: Vec3} | null}
 */
export function boxOf(displays) {
  const inverse = toThree().clone().invert();
  /** @type {Vec3} */
  const low = [Infinity, Infinity, Infinity];
  /** @type {Vec3} */
  const high = [-Infinity, -Infinity, -Infinity];
  const starts = displays.map((id) => `${constants.ROOT}/${encodeURIComponent(`${id}/`)}`);
  for (const [name, node] of Object.entries(viser.nodes())) {
    if (!node || !starts.some((start) => name.startsWith(start))) continue;
    node.traverse((object) => {
      if (!object.visible || !object.geometry) return;
      object.geometry.computeBoundingBox();
      const { min, max } = object.geometry.boundingBox ?? {};
      if (!min || !Number.isFinite(min.x + max.x + min.y + max.y + min.z + max.z)) return;
      object.updateWorldMatrix(true, false);
      for (let corner = 0; corner < 8; corner++) {
        const at = min.clone();
        if (corner & 1) at.x = max.x;
        if (corner & 2) at.y = max.y;
        if (corner & 4) at.z = max.z;
        const xyz = at.applyMatrix4(object.matrixWorld).applyMatrix4(inverse).toArray();
        for (const axis of AXES) {
          low[axis] = Math.min(low[axis], xyz[axis]);
          high[axis] = Math.max(high[axis], xyz[axis]);
        }
      }
    });
  }
  return low[0] <= high[0] ? { low, high } : null;
}
