// Meshes with a colour for each vertex.
//
// viser's have one colour. Here the colours come as further vertices, which no face has, see
// scene/meshes.py, and its toon material of five steps says that they are there. Between the vertices
// they are mixed as in RViz, in sRGB.

import * as viser from "webviz/viser_page.js";
import { lit } from "webviz/scene/shade.js";

/** @import {BufferAttribute, BufferGeometry} from "three" */
/** @import {SceneObject, Shader} from "webviz/types.js" */

const STEPS = 5;

export function install() {
  viser.beforeRender((gl, scene) => scene.traverse(paint));
}

/** @param {SceneObject} mesh */
function paint({ isMesh, isInstancedMesh, isInstancedMesh2, geometry, material }) {
  if (!isMesh || isInstancedMesh || isInstancedMesh2) return;
  if (material.gradientMap?.image.width !== STEPS) return;
  const { position } = geometry.attributes;
  if (!position) return;
  const version = `${position.version} ${position.array.length}`;
  if (geometry.webvizColors !== version) {
    geometry.webvizColors = version;
    readColors(geometry, position);
  }
  if (material.webviz) return;
  material.webviz = true;
  material.vertexColors = true;
  material.depthWrite = !material.transparent;
  material.onBeforeCompile = (/** @type {Shader} */ shader) => {
    lit(shader);
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <color_fragment>",
      `
      diffuseColor *= vec4(pow(vColor.rgb, vec3(2.2)), vColor.a);`,
    );
  };
  material.customProgramCacheKey = () => "webviz colors";
  material.needsUpdate = true;
}

/**
 * @param {BufferGeometry} geometry
 * @param {BufferAttribute} attribute
 */
function readColors(geometry, { array, constructor }) {
  const Attribute = /** @type {typeof BufferAttribute} */ (constructor);
  const count = array.length / 6;
  let { color } = geometry.attributes;
  if (color?.count !== count) {
    geometry.dispose(); // frees the buffers in the graphics card; those that stay are made anew
    geometry.setAttribute("color", (color = new Attribute(new Float32Array(4 * count), 4)));
  }
  const colors = color.array;
  for (let i = 0, j = array.length / 2; i < colors.length; i += 4, j += 3) {
    const [red, blue] = [array[j] * 256, array[j + 1] * 256];
    colors[i] = Math.floor(red) / 255;
    colors[i + 1] = ((red % 1) * 256) / 255;
    colors[i + 2] = Math.floor(blue) / 255;
    colors[i + 3] = ((blue % 1) * 256) / 255;
  }
  color.needsUpdate = true;
  // Without the colours; of what is drawn and what is picked.
  const corners = new Attribute(array.subarray(0, array.length / 2), 3);
  if (!geometry.boundingSphere) geometry.computeBoundingSphere();
  geometry.computeBoundingBox();
  const { boundingBox: box, boundingSphere: sphere } = geometry;
  if (box && sphere) box.setFromBufferAttribute(corners).getBoundingSphere(sphere);
}
