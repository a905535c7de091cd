// How lines look.
//
// The ends of lines with a width in metres are square, as RViz's, where viser's are round; joints
// stay round. And a segment that passes by the camera is cut where it is well off the screen. viser
// cuts it next to the camera, where its projection is so long that the depth along it is wrong by
// centimetres: what lies in one plane with the floor came and went. Between the ends, colours are
// mixed as in RViz, in sRGB. Shaders and attributes are those
// of LineMaterial and LineSegmentsGeometry in three-stdlib.

import * as viser from "../viser_page.js";

// Where the segment leaves a pyramid four times as wide as what is seen.
const cut = (source) =>
  source.replace(
    "end.xyz = mix( start.xyz, end.xyz, alpha );",
    `vec2 wide = vec2(4.0 / projectionMatrix[0][0], 4.0 / projectionMatrix[1][1]);
     for (float side = -1.0; side < 2.0; side += 2.0) {
       vec2 from = side * start.xy - wide * start.z;
       vec2 to = side * end.xy - wide * end.z;
       if (from.x > 0.0 && to.x < 0.0) alpha = min(alpha, from.x / (from.x - to.x));
       if (from.y > 0.0 && to.y < 0.0) alpha = min(alpha, from.y / (from.y - to.y));
     }
     end.xyz = mix(start.xyz, end.xyz, alpha);`,
  );

const passing = (source) =>
  "attribute vec2 webvizOpen; varying vec2 vOpen;" +
  cut(source)
    .replace("worldStart = start.xyz;", "worldStart = start.xyz; vOpen = webvizOpen;")
    .replace(
      "? instanceColorStart : instanceColorEnd;",
      "$& vLineColor.rgb = pow(vLineColor.rgb, vec3(1.0 / 2.2));",
    );

const square = (source) =>
  "varying vec2 vOpen; float along;" +
  source
    .replace("diffuseColor.rgb *= vLineColor;", "diffuseColor.rgb *= pow(vLineColor, vec3(2.2));")
    .replace(
      "diffuseColor *= vLineColor;",
      "diffuseColor *= vec4(pow(vLineColor.rgb, vec3(2.2)), vLineColor.a);",
    )
    .replace("mua = clamp(", "along = mua; mua = clamp(")
    .replace(
      "vec3 p1 = worldStart",
      `if (along < 0.0 && vOpen.x > 0.5 || along > 1.0 && vOpen.y > 0.5) discard;
       vec3 p1 = worldStart`,
    );

// An end is open unless the segment before or after goes on from there.
function markOpenEnds(geometry) {
  const { instanceStart } = geometry.attributes;
  if (!instanceStart) return;
  const xyz = instanceStart.data.array;
  const count = xyz.length / 6;
  const meet = (i, j) =>
    xyz[i] === xyz[j] && xyz[i + 1] === xyz[j + 1] && xyz[i + 2] === xyz[j + 2];
  const open = new Float32Array(2 * count);
  for (let i = 0; i < count; i++) {
    const before = i > 0 ? i - 1 : count - 1;
    const after = i < count - 1 ? i + 1 : 0;
    open[2 * i] = meet(6 * i, 6 * before + 3) ? 0 : 1;
    open[2 * i + 1] = meet(6 * i + 3, 6 * after) ? 0 : 1;
  }
  const buffer = new instanceStart.data.constructor(open, 2, 1);
  geometry.setAttribute("webvizOpen", new instanceStart.constructor(buffer, 2, 0));
}

export function install() {
  viser.beforeEveryRender((gl, scene) => {
    scene.traverse(({ isLineSegments2, geometry, material }) => {
      if (!isLineSegments2) return;
      if (material.worldUnits && !geometry.attributes.webvizOpen) markOpenEnds(geometry);
      if (material.webviz) return;
      material.webviz = true;
      material.vertexShader = passing(material.vertexShader);
      material.fragmentShader = square(material.fragmentShader);
      material.needsUpdate = true;
    });
  });
}
