// Points with an opacity, which viser draws opaque. As in RViz, translucent ones hide nothing behind them.
//
// The opacity is in the last bits of the size, which viser multiplies before it draws; so it is read
// from the messages.

import { markOf } from "./marks.js";
import * as viser from "../viser_page.js";

/** @import {Three, ViserMessage} from "../types.js" */

/** @type {Map<string, number>} */
const opacities = new Map(); // by the name of the node, once it was less than 1

export function install() {
  viser.filterMessages((messages) => {
    messages.forEach(read);
    return messages;
  });
  viser.beforeEveryRender((gl, scene) => {
    scene.traverse(({ isPoints, material }) => isPoints && patch(material));
    for (const [name, opacity] of opacities) {
      viser.node(name)?.traverse(({ isPoints, material }) => isPoints && blend(material, opacity));
    }
  });
}

/** @param {ViserMessage} message */
function read({ type, name, props, updates }) {
  if (type === "RemoveSceneNodeMessage") {
    for (const each of opacities.keys()) {
      if (each === name || each.startsWith(`${name}/`)) opacities.delete(each);
    }
  }
  const size = (updates ?? props)?.point_size;
  if (size === undefined) return;
  const opacity = 1 - markOf(size) / 255;
  if (opacity < 1 || opacities.has(name)) opacities.set(name, opacity);
}

// All of them, so that they share a shader.
/** @param {Three} material */
function patch(material) {
  if (material.uniforms?.webvizOpacity || !material.uniforms?.point_ball_norm) return;
  material.uniforms.webvizOpacity = { value: 1 };
  material.fragmentShader = `uniform float webvizOpacity;
    ${material.fragmentShader.replace("vec4(col, 1.0)", "vec4(col, webvizOpacity)")}`;
  material.needsUpdate = true;
}

/**
 * @param {Three} material
 * @param {number} opacity
 */
function blend(material, opacity) {
  if (!material.uniforms?.webvizOpacity) return;
  material.uniforms.webvizOpacity.value = opacity;
  material.transparent = opacity < 1;
  material.depthWrite = opacity === 1;
}
