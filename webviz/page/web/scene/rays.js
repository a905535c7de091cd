// Rays from the camera through points of the window.

import * as viser from "webviz/viser_page.js";

/** @import {Raycaster} from "three" */
/** @import {Vec2} from "webviz/types.js" */

/**
 * The raycaster through a point of the window, in three.js' coordinates.
 *
 * @param {Vec2} xy
 * @returns {Raycaster}
 */
export function casterAt([x, y]) {
  const box = viser.canvas().getBoundingClientRect();
  const [across, down] = [(x - box.left) / box.width, (y - box.top) / box.height];
  const caster = new (viser.Raycaster())();
  /** @type {any} */
  const place = { x: across * 2 - 1, y: 1 - down * 2 }; // all that it reads of a vector
  caster.setFromCamera(place, viser.camera());
  return caster;
}
