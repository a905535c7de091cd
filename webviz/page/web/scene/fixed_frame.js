// Where the fixed frame is in three.js, whose y points up.

import constants from "../constants.js";
import * as viser from "../viser_page.js";

/** @import {Three} from "../types.js" */

/** @type {Three} */
let node = null;

/**
 * The transform from the fixed frame to three.js. Its node is made anew when a lost connection is
 * back, and until then the last one counts.
 *
 * @returns {Three}
 */
export function toThree() {
  node = viser.node(constants.ROOT) ?? node;
  node.updateWorldMatrix(true, false);
  return node.matrixWorld;
}
