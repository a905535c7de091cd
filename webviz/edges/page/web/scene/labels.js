// How texts look.
//
// viser draws black letters on white boxes, from distance fields. Here the boxes are hidden, and the
// letters are white with a dark outline that the same fields give: legible on any ground, and
// covering no more of the scene than they need. The render orders are those of viser's
// renderOrders.ts; shaders and uniforms, LabelRenderer.tsx's.

import * as viser from "../viser_page.js";

const BOXES = 10001;
const LETTERS = 10002;

// Each letter is drawn in a quad without room for an outline; the atlas has it.
const widened = (source) =>
  "uniform float uSdfRadius;" +
  source.replace(
    "vec2 corner = position.xy;",
    `vec2 room = 0.5 * uSdfRadius / aRect.zw;
     vec2 corner = position.xy * (1.0 + 2.0 * room) - room;`,
  );

// The outline is about a pixel wide; that of letters that are large is wider.
const OUTLINED = `
  uniform sampler2D uAtlas;
  uniform vec2 uAtlasSize;
  uniform float uSdfRadius;
  varying vec2 vUv;
  varying float vAlpha;

  void main() {
    float inside = (texture2D(uAtlas, vUv).r - 0.5) * 2.0 * uSdfRadius;
    float pixel = 0.7071 * length(fwidth(vUv * uAtlasSize));
    float soft = clamp(0.6 * pixel, 1e-4, 0.4 * uSdfRadius);
    float outline = clamp(pixel, 0.15 * uSdfRadius, 0.9 * uSdfRadius - soft);
    float alpha = vAlpha * smoothstep(-soft, soft, inside + outline);
    if (alpha < 0.004) discard;
    gl_FragColor = vec4(vec3(smoothstep(-soft, soft, inside)), alpha);
  }`;

export function install() {
  let group = null;
  viser.beforeRender((gl, scene) => {
    if (!group || !group.parent) {
      scene.traverse((object) => object.renderOrder === BOXES && (group = object.parent));
    }
    for (const mesh of group ? group.children : []) {
      if (mesh.renderOrder === BOXES) mesh.visible = false;
      if (mesh.renderOrder !== LETTERS || mesh.webviz) continue;
      mesh.webviz = true;
      mesh.material.vertexShader = widened(mesh.material.vertexShader);
      mesh.material.fragmentShader = OUTLINED;
      mesh.material.needsUpdate = true;
    }
  });
}
