// Sheets, such as cells of a grid: in their exact colour, and over lines that lie in their plane, which
// are blended before them. viser's toon material of three steps says what is one, see scene/meshes.py.

import * as viser from "webviz/viser_page.js";

/** @import {Shader} from "webviz/types.js" */

const STEPS = 3;
const AFTER_LINES = 1;

/** @param {Shader} shader */
const flat = (shader) => {
  // By as much as pictures lie behind lines, see tiles.js.
  shader.vertexShader = shader.vertexShader.replace(
    "#include <project_vertex>",
    `
    #include <project_vertex>
    #ifdef USE_REVERSED_DEPTH_BUFFER
      gl_Position.z += isPerspectiveMatrix(projectionMatrix) ? 5e-4 * gl_Position.z : 2e-6;
    #else
      gl_Position.z -= isPerspectiveMatrix(projectionMatrix)
        ? 5e-4 * (gl_Position.w - gl_Position.z) : 4e-6;
    #endif`,
  );
};

export function install() {
  viser.beforeEveryRender((gl, scene) =>
    scene.traverse((object) => {
      const { isMesh, isInstancedMesh, isInstancedMesh2, material } = object;
      if (!isMesh || isInstancedMesh || isInstancedMesh2) return;
      if (material.gradientMap?.image.width !== STEPS) return;
      object.renderOrder = AFTER_LINES;
      material.depthWrite = !material.transparent;
      if (material.onBeforeCompile === flat) return;
      // Lines are up to a pixel wider than what they stand for, and so in front of a slope.
      material.polygonOffset = true;
      material.polygonOffsetFactor = -1;
      material.onBeforeCompile = flat;
      material.customProgramCacheKey = () => "webviz flat";
      material.needsUpdate = true;
    }),
  );
}
