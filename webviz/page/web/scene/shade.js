// Shading of surfaces: by the view, and boxes of data by their sides.
//
// A surface that faces the camera has its own colour, and the less it does the darker it is, as if
// by the one light of RViz, which shines from the camera. That is in sRGB, as there: the lights of
// three.js add up in linear light, which leaves a ball that is lit from the camera as flat as a
// disc. Solids whose colours are data look like the points of RViz's clouds, wherever one stands:
// spheres are hardly darker at the rim, and each side of a box has a brightness of its own, and darker
// edges; squares have their exact colour. Of viser's toon materials nothing but the shader is left, and
// the number of steps: three for spheres, five for boxes and squares, see scene/instances.py.

import constants from "webviz/constants.js";
import * as viser from "webviz/viser_page.js";

/** @import {SceneObject, Shader} from "webviz/types.js" */

const { DARKEST } = constants;
const BOX_STEPS = 5;

/**
 * Shades like a surface.
 *
 * @param {Shader} shader
 */
export function lit(shader) {
  shader.fragmentShader = shader.fragmentShader.replace(
    "#include <opaque_fragment>",
    `
    float facing = max(normalize(normal).z, 0.0);
    outgoingLight = diffuseColor.rgb * pow(${DARKEST} + (1.0 - ${DARKEST}) * facing, 2.2);
    outgoingLight += totalEmissiveRadiance;
    #include <opaque_fragment>`,
  );
}

// The numbers are those of shaded_circle.frag and box.frag in rviz_rendering; the sides are as seen in
// RViz. The edge of a box that is less than a pixel wide darkens the pixel as much as it covers of it.
/** @param {Shader} shader */
function asData(shader) {
  shader.vertexShader = shader.vertexShader
    .replace(
      "#include <common>",
      `
      #include <common>
      varying vec3 vPlace; varying vec3 vSide;`,
    )
    .replace(
      "#include <begin_vertex>",
      `
      #include <begin_vertex>
      vPlace = position;
      vSide = normal;`,
    );
  shader.fragmentShader = shader.fragmentShader
    .replace(
      "#include <common>",
      `
      #include <common>
      varying vec3 vPlace; varying vec3 vSide;
      vec3 onSphere(vec3 color, float facing) {
        return color * (0.8 + 0.2 * facing * facing);
      }
      vec3 onBox(vec3 color) {
        bool isSquare = dot(vPlace, vSide) < 0.25;
        if (isSquare) return color;
        vec3 ahead = vec3(0.6, 0.4, 0.9);
        vec3 behind = vec3(0.6, 1.0, 0.5);
        color *= dot(max(vSide, 0.0), ahead) + dot(max(-vSide, 0.0), behind);
        vec3 place = abs(vPlace) * (1.0 - abs(vSide));
        float outward = max(max(place.x, place.y), place.z);
        float edge = clamp(0.5 + (outward - 0.465) / max(fwidth(outward), 0.03), 0.0, 1.0);
        return color * (1.0 - 0.5 * edge);
      }`,
    )
    .replace(
      "#include <opaque_fragment>",
      `
      vec3 data = sRGBTransferOETF(diffuseColor).rgb;
      float facing = dot(normalize(normal), normalize(vViewPosition));
      bool isBox = textureSize(gradientMap, 0).x == ${BOX_STEPS};
      data = isBox ? onBox(data) : onSphere(data, facing);
      outgoingLight = sRGBTransferEOTF(vec4(data, 1.0)).rgb;
      #include <opaque_fragment>`,
    );
}

/** @type {Record<string, (shader: Shader) => void>} */
const shades = { MeshStandardMaterial: lit, MeshToonMaterial: asData };

// Before the first of a kind is drawn, for viser's batches keep what a material had when it was.
// A physical material is a standard one with more to it.
/** @param {SceneObject} mesh */
function teach({ material }) {
  if (!material) return;
  const isPhysical = material.isMeshPhysicalMaterial;
  const type = isPhysical ? "MeshStandardMaterial" : material.type;
  if (!shades[type]) return;
  let kind = Object.getPrototypeOf(material);
  if (isPhysical) kind = Object.getPrototypeOf(kind);
  kind.onBeforeCompile = shades[type];
  kind.customProgramCacheKey = () => `webviz ${type}`;
  delete shades[type];
}

export function install() {
  viser.beforeEveryRender((gl, scene) => {
    if (Object.keys(shades).length > 0) scene.traverse(teach);
  });

  // As in RViz, a transparent object does not hide anything behind it, its own back included.
  viser.beforeDraw((material) => {
    if (material.transparent && "isMeshStandardMaterial" in material) material.depthWrite = false;
  });
}
