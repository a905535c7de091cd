"""How solids are shaded whose colours are data: a script that every browser runs when it joins.

They are viser's toon materials, of which nothing but the shader is left: as in RViz's spheres, the
middle has the very colour and the rim 0.8 of it, wherever light comes from.
"""

from __future__ import annotations

SHADE_SCRIPT = """
(function install() {
  const scene = window.__viserMutable && window.__viserMutable.scene;
  if (!scene || !scene.webviz) return requestAnimationFrame(install);
  if (scene.webvizShade) return;
  scene.webvizShade = true;

  const shade = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace("#include <opaque_fragment>", `
      float facing = dot(normalize(normal), normalize(vViewPosition));
      outgoingLight = diffuseColor.rgb * pow(0.8 + 0.2 * facing * facing, 2.2);
      #include <opaque_fragment>`);
  };
  let toon = null;
  const before = scene.onBeforeRender;
  scene.onBeforeRender = function (...args) {
    if (!toon) {
      scene.traverse(({ material }) => {
        if (!material || !material.isMeshToonMaterial) return;
        toon = Object.getPrototypeOf(material);
        toon.onBeforeCompile = shade;
        material.needsUpdate = true;
      });
    }
    return before.apply(this, args);
  };
})();
"""
