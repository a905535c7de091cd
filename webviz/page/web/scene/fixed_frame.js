// Pose of the fixed frame in three.js, whose y points up.

import constants from "webviz/constants.js";
import * as viser from "webviz/viser_page.js";

/** @import {Matrix4} from "three" */
/** @import {SceneObject} from "webviz/types.js" */

/** @type {SceneObject | null} */
let node = null;

/**
 * The transform from the fixed frame to three.js. Its node is made anew when a lost connection is
 * back, and until then the last one counts.
 *
 * @returns {Matrix4}
 */
export function toThree() {
  node = viser.node(constants.ROOT) ?? node;
  if (!node) throw new Error("viser has not made the root of the scene yet.");
  node.updateWorldMatrix(true, false);
  return node.matrixWorld;
}
