// Pose of the fixed frame in three.js, whose y points up.

import constants from "webviz/constants.js";
import { signal, untracked } from "webviz/signals.js";
import * as viser from "webviz/viser_page.js";

/** @import {Matrix4} from "three" */
/** @import {SceneObject} from "webviz/types.js" */

const root = signal(/** @type {SceneObject | null} */ (null));

/**
 * The transform from the fixed frame to three.js. Its node is made anew when a lost connection is
 * back, and until then the last one counts.
 *
 * @returns {Matrix4}
 */
export function toThree() {
  const node = viser.node(constants.ROOT) ?? untracked(() => root.value);
  if (!node) throw new Error("viser has not made the root of the scene yet.");
  root.value = node;
  node.updateWorldMatrix(true, false);
  return node.matrixWorld;
}
