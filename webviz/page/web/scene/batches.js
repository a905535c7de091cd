// Frees what batches that are gone have in the graphics card.
//
// viser makes a new batch for each change of its opacities, and frees the old one before it is drawn
// for the last time, which has it uploaded again.

import * as viser from "webviz/viser_page.js";

/** @import {SceneObject} from "webviz/types.js" */

export function install() {
  /** @type {Set<SceneObject>} */
  let before = new Set();
  viser.afterRender(() => {
    /** @type {Set<SceneObject>} */
    const batches = new Set();
    viser.scene().traverse((object) => object.isInstancedMesh2 && batches.add(object));
    for (const batch of before) if (!batches.has(batch)) batch.geometry.dispose();
    before = batches;
  });
}
