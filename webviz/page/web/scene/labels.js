// Appearance of texts.
//
// viser draws black letters on white boxes, from distance fields. Here the boxes are hidden, and the
// letters have a colour and an outline that the same fields give, dark around light letters and light
// around dark ones: legible on any ground, and covering no more of the scene than they need. The
// colour and opacity are in the last bits of the height, see scene/labels.py. The render orders are
// those of viser's renderOrders.ts; shaders and uniforms, LabelRenderer.tsx's. One code of a colour
// stands for that of the theme.

import constants from "webviz/constants.js";
import { signal } from "webviz/signals.js";
import { scheme } from "webviz/scene/scheme.js";
import * as viser from "webviz/viser_page.js";

/** @import {SceneObject} from "webviz/types.js" */

const BOXES = 10001;
const LETTERS = 10002;

// Each letter is drawn in a quad without room for an outline; the atlas has it.
/** @param {string} source */
const widened = (source) =>
  "uniform float uSdfRadius; uniform vec3 uTextColor; varying vec3 vColor; varying float vOpacity;" +
  source.replace(
    "vec2 corner = position.xy;",
    `vec2 room = 0.5 * uSdfRadius / aRect.zw;
     vec2 corner = position.xy * (1.0 + 2.0 * room) - room;
     uint bits = floatBitsToUint(aParams.y);
     vOpacity = 1.0 - float((bits >> 15) & 3u) / 4.0;
     uvec3 code = uvec3((bits >> 10) & 31u, (bits >> 5) & 31u, bits & 31u);
     vColor = code == uvec3(${constants.TEXT_CODE}) ? uTextColor : vec3(code) / 31.0;`,
  );

// The outline is about a pixel wide; that of letters that are large is wider.
const OUTLINED = `
  uniform sampler2D uAtlas;
  uniform vec2 uAtlasSize;
  uniform float uSdfRadius;
  varying vec2 vUv;
  varying float vAlpha;
  varying vec3 vColor;
  varying float vOpacity;

  void main() {
    float inside = (texture2D(uAtlas, vUv).r - 0.5) * 2.0 * uSdfRadius;
    float pixel = 0.7071 * length(fwidth(vUv * uAtlasSize));
    float soft = clamp(0.6 * pixel, 1e-4, 0.4 * uSdfRadius);
    float outline = clamp(pixel, 0.15 * uSdfRadius, 0.9 * uSdfRadius - soft);
    float alpha = vAlpha * vOpacity * smoothstep(-soft, soft, inside + outline);
    if (alpha < 0.004) discard;
    float light = dot(vColor, vec3(0.299, 0.587, 0.114));
    vec3 around = vec3(light < 0.25 ? 0.75 : 0.0);
    gl_FragColor = vec4(mix(around, vColor, smoothstep(-soft, soft, inside)), alpha);
  }`;

const group = signal(/** @type {SceneObject | null} */ (null));
const ofTheme = { value: [1, 1, 1] };

/** The boxes behind the letters, one of a mesh for each text: where the texts are, and how large. */
export const boxes = () =>
  group.value ? group.value.children.filter(({ renderOrder }) => renderOrder === BOXES) : [];

export function install() {
  viser.beforeEveryRender((gl, scene) => {
    if (!group.value?.parent) {
      scene.traverse((object) => object.renderOrder === BOXES && (group.value = object.parent));
    }
    ofTheme.value = scheme().text.map((byte) => byte / 255);
    for (const mesh of group.value?.children ?? []) {
      if (mesh.renderOrder === BOXES) mesh.visible = false;
      if (mesh.renderOrder !== LETTERS || mesh.webviz) continue;
      mesh.webviz = true;
      mesh.material.vertexShader = widened(mesh.material.vertexShader);
      mesh.material.fragmentShader = OUTLINED;
      mesh.material.uniforms.uTextColor = ofTheme;
      mesh.material.needsUpdate = true;
    }
  });
}
