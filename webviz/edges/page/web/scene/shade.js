// How surfaces are shaded, from the view alone.
//
// A surface that faces the camera has its own colour, and the less it does the darker it is, as if
// by the one light of RViz, which shines from the camera. That is in sRGB, as there: the lights of
// three.js add up in linear light, which leaves a ball that is lit from the camera as flat as a
// disc. Solids whose colours are data (viser's toon materials, of which nothing but the shader is
// left) are, as RViz's spheres, hardly darker at the rim.

import constants from "../constants.js";
import * as viser from "../viser_page.js";

const { DARKEST } = constants;

const shade = (factor) => (shader) => {
  shader.fragmentShader = shader.fragmentShader.replace("#include <opaque_fragment>", `
    outgoingLight = diffuseColor.rgb * pow(${factor}, 2.2) + totalEmissiveRadiance;
    #include <opaque_fragment>`);
};
const facing = "dot(normalize(normal), normalize(vViewPosition))";
const factors = {
  MeshStandardMaterial: `${DARKEST} + (1.0 - ${DARKEST}) * max(normalize(normal).z, 0.0)`,
  MeshToonMaterial: `0.8 + 0.2 * ${facing} * ${facing}`,
};

/** Shades a material of another kind like a surface. */
export const lit = shade(factors.MeshStandardMaterial);

// Before the first of a kind is drawn, for viser's batches keep what a material had when it was.
// A physical material is a standard one with more to it.
function teach({ material }) {
  if (!material) return;
  const isPhysical = material.isMeshPhysicalMaterial;
  const type = isPhysical ? "MeshStandardMaterial" : material.type;
  if (!factors[type]) return;
  let kind = Object.getPrototypeOf(material);
  if (isPhysical) kind = Object.getPrototypeOf(kind);
  kind.onBeforeCompile = shade(factors[type]);
  kind.customProgramCacheKey = () => `webviz ${type}`;
  delete factors[type];
}

export function install() {
  viser.beforeEveryRender((gl, scene) => {
    if (Object.keys(factors).length > 0) scene.traverse(teach);
  });

  // As in RViz, a transparent object does not hide anything behind it, its own back included.
  viser.beforeDraw((material) => {
    if (material.transparent && material.isMeshStandardMaterial) material.depthWrite = false;
  });
}
