// Pictures: sharp cells; behind lines and meshes of the same plane, and by layer over each other;
// never hiding what is blended later; not a white sheet while the first texture is decoded.

import constants from "webviz/constants.js";
import * as viser from "webviz/viser_page.js";

/** @import {Shader} from "webviz/types.js" */

const MARK = `/${constants.TILE_PREFIX}`;
// Of three.js.
const NEAREST = 1003;
const BOTH_SIDES = 2;

// By 0.05 % of the distance, in a parallel projection by some steps of the depth buffer: more
// than errors of rounding, less than what lies between two things. Units of a polygon offset
// would hardly count, and three.js takes them for the opposite when it reverses the depth; its
// factor is for lines, which are up to half a pixel wider than what they stand for.
/** @param {Shader} shader */
const pushBack = (shader) => {
  shader.vertexShader = shader.vertexShader.replace(
    "#include <project_vertex>",
    `
    #include <project_vertex>
    #ifdef USE_REVERSED_DEPTH_BUFFER
      gl_Position.z -= isPerspectiveMatrix(projectionMatrix) ? 5e-4 * gl_Position.z : 2e-6;
    #else
      gl_Position.z += isPerspectiveMatrix(projectionMatrix)
        ? 5e-4 * (gl_Position.w - gl_Position.z) : 4e-6;
    #endif`,
  );
};
/** @param {string} name */
const layerOf = (name) => parseInt(name.split(MARK)[1]);
export function install() {
  viser.beforeEveryRender(() => {
    const nodes = viser.nodes();
    for (const name in nodes) {
      if (!name.includes(MARK) || !nodes[name]) continue;
      nodes[name].traverse((object) => {
        const material = object.material;
        if (!object.isMesh || !material || material.side !== BOTH_SIDES) return;
        const texture = material.map;
        object.visible = !!texture;
        if (texture && texture.magFilter !== NEAREST) {
          texture.magFilter = NEAREST;
          texture.needsUpdate = true;
        }
        if (material.onBeforeCompile !== pushBack) {
          object.renderOrder = layerOf(name) - 1e6;
          material.depthWrite = false;
          material.polygonOffset = true;
          material.polygonOffsetFactor = 0.5;
          material.onBeforeCompile = pushBack;
          material.needsUpdate = true;
        }
      });
    }
  });
}
