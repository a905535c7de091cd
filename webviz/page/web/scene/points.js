// Points with an opacity, which viser draws opaque, and points whose size grows with the distance from a
// plane. As in RViz, translucent ones hide nothing behind them.
//
// The opacity is in the last bits of the size, which viser multiplies before it draws; so it is read
// from the messages, as the plane is, which viser does not know.

import { markOf } from "webviz/scene/marks.js";
import * as viser from "webviz/viser_page.js";

/** @import {ShaderMaterial} from "three" */
/** @import {SceneObject, ViserMessage} from "webviz/types.js" */

/** @typedef {{opacity: number, plane: number[]}} Look */

const SAME_SIZE = [0, 0, 0, 1]; // a plane that all points are 1 m away from

/** @type {Map<string, Look>} */
const looks = new Map(); // by the name of the node, once it is no longer viser's

export function install() {
  viser.filterMessages((messages) => {
    messages.forEach(read);
    return messages;
  });
  viser.beforeEveryRender((gl, scene) => {
    scene.traverse(({ isPoints, material }) => isPoints && patch(material));
    for (const [name, look] of looks) {
      viser.node(name)?.traverse(({ isPoints, material }) => isPoints && show(material, look));
    }
  });
}

/** @param {ViserMessage} message */
function read({ type, name, props, updates }) {
  if (type === "RemoveSceneNodeMessage") {
    for (const each of looks.keys()) {
      if (each === name || each.startsWith(`${name}/`)) looks.delete(each);
    }
  }
  const { point_size: size, plane } = updates ?? props ?? {};
  const look = looks.get(name) ?? { opacity: 1, plane: SAME_SIZE };
  if (size !== undefined) look.opacity = 1 - markOf(size) / 255;
  if (plane !== undefined) look.plane = plane ?? SAME_SIZE;
  if (look.opacity < 1 || look.plane !== SAME_SIZE) looks.set(name, look);
}

// All of them, so that they share a shader.
/** @param {ShaderMaterial} material */
function patch(material) {
  if (material.uniforms?.webvizOpacity || !material.uniforms?.point_ball_norm) return;
  material.uniforms.webvizOpacity = { value: 1 };
  material.uniforms.webvizPlane = { value: SAME_SIZE };
  material.fragmentShader = `uniform float webvizOpacity;
    ${material.fragmentShader.replace("vec4(col, 1.0)", "vec4(col, webvizOpacity)")}`;
  material.vertexShader = `uniform vec4 webvizPlane;
    ${material.vertexShader.replace("(scale /", "(dot(webvizPlane, vec4(position, 1.0)) * scale /")}`;
  material.needsUpdate = true;
}

/**
 * @param {ShaderMaterial} material
 * @param {Look} look
 */
function show(material, { opacity, plane }) {
  if (!material.uniforms?.webvizOpacity) return;
  material.uniforms.webvizOpacity.value = opacity;
  material.uniforms.webvizPlane.value = plane;
  material.transparent = opacity < 1;
  material.depthWrite = opacity === 1;
}

/**
 * The plane from which points of a cloud grow, as four numbers.
 *
 * @param {SceneObject} points
 * @returns {number[]}
 */
export const planeOf = ({ material }) => material.uniforms.webvizPlane?.value ?? SAME_SIZE;
