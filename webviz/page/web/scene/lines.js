// Appearance of lines.
//
// Lines with an opacity blend; viser's are opaque. The opacity is in the last bits of the width, see
// marks.js, with a mark of those that have the colour of the theme. The ends of lines with a width in metres are square, as RViz's, where viser's are
// round; their joints are mitred, so that the segments next to each other share an edge and none of
// them is blended twice, but round where a line turns back. And a segment that passes by the camera
// is cut where it is well off the screen. viser cuts it next to the camera, where its projection is
// so long that the depth along it is wrong by centimetres: what lies in one plane with the floor came
// and went. Between the ends, colours are mixed as in RViz, in sRGB. Shaders and attributes are those
// of LineMaterial and LineSegmentsGeometry in three-stdlib.

import { markOf } from "webviz/scene/marks.js";
import { paint, scheme } from "webviz/scene/scheme.js";
import * as viser from "webviz/viser_page.js";

/** @import {BufferGeometry, Color, InstancedInterleavedBuffer} from "three" */
/** @import {InterleavedBufferAttribute, ShaderMaterial} from "three" */

/**
 * Geometry and material of LineSegments2, with the attributes that are added here.
 *
 * @typedef {"instanceStart" | "webvizStart" | "webvizEnd"} Attributes
 * @typedef {BufferGeometry<Partial<Record<Attributes, InterleavedBufferAttribute>>>} LineGeometry
 * @typedef {ShaderMaterial & {linewidth: number, worldUnits: boolean, color: Color}} LineMaterial
 */

const OF_THEME = 256;

// End of the segment in a pyramid four times as wide as what is seen.
/** @param {string} source */
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

// Of an end: the direction of the line there, and what the end is.
const OPEN = 0;
const MITRED = 1;
const ROUND = 2;

/** @param {string} source */
const passing = (source) =>
  `attribute vec4 webvizStart; attribute vec4 webvizEnd; varying vec4 vStart; varying vec4 vEnd;
   ${cut(source)}`
    .replace(
      "worldStart = start.xyz;",
      `worldStart = start.xyz;
       vStart = vec4(mat3(modelViewMatrix) * webvizStart.xyz, webvizStart.w);
       vEnd = vec4(mat3(modelViewMatrix) * webvizEnd.xyz, webvizEnd.w);`,
    )
    .replace(
      "? instanceColorStart : instanceColorEnd;",
      "$& vLineColor.rgb = pow(vLineColor.rgb, vec3(1.0 / 2.2));",
    );

// A joint is cut as seen from the camera, alike for both of its segments.
/** @param {string} source */
const square = (source) =>
  `varying vec4 vStart; varying vec4 vEnd; float along;
   float beyond(vec3 ray, vec3 joint, vec3 ahead) {
     return dot(ray * (dot(joint, joint) / dot(ray, joint)) - joint, ahead);
   }
   bool is(float kind, int other) { return int(kind + 0.5) == other; }
   ${source}`
    .replace("diffuseColor.rgb *= vLineColor;", "diffuseColor.rgb *= pow(vLineColor, vec3(2.2));")
    .replace(
      "diffuseColor *= vLineColor;",
      "diffuseColor *= vec4(pow(vLineColor.rgb, vec3(2.2)), vLineColor.a);",
    )
    .replace(
      "mua = clamp( mua, 0.0, 1.0 );",
      `along = mua;
       float corner = linewidth * inversesqrt(d2121);
       mua = clamp(mua, is(vStart.w, ${MITRED}) ? -corner : 0.0, is(vEnd.w, ${MITRED}) ? 1.0 + corner : 1.0);`,
    )
    .replace(
      "vec3 p1 = worldStart",
      `if (along < 0.0 && is(vStart.w, ${OPEN}) || along > 1.0 && is(vEnd.w, ${OPEN})) discard;
       if (is(vStart.w, ${MITRED}) && beyond(rayEnd, worldStart, vStart.xyz) < 0.0) discard;
       if (is(vEnd.w, ${MITRED}) && beyond(rayEnd, worldEnd, vEnd.xyz) >= 0.0) discard;
       vec3 p1 = worldStart`,
    );

// An end is open unless the segment before or after goes on from there.
/** @param {LineGeometry} geometry */
function markEnds(geometry) {
  const { instanceStart } = geometry.attributes;
  if (!instanceStart) return;
  const xyz = instanceStart.data.array;
  const count = xyz.length / 6;
  const ends = new Float32Array(8 * count); // of each segment, that of its start and of its end
  const [from, to] = [
    [0, 0, 0],
    [0, 0, 0],
  ];
  for (let i = 0; i < count; i++) {
    const next = i < count - 1 ? i + 1 : 0;
    if ([0, 1, 2].some((axis) => xyz[6 * i + 3 + axis] !== xyz[6 * next + axis])) continue;
    direction(xyz, i, from);
    direction(xyz, next, to);
    const cos = from[0] * to[0] + from[1] * to[1] + from[2] * to[2];
    const joint = [0, 1, 2].map((axis) => from[axis] + to[axis]);
    joint.push(cos >= 0 && from.some(Boolean) && to.some(Boolean) ? MITRED : ROUND);
    ends.set(joint, 8 * i + 4);
    ends.set(joint, 8 * next);
  }
  const Buffer = /** @type {typeof InstancedInterleavedBuffer} */ (instanceStart.data.constructor);
  const Attribute = /** @type {typeof InterleavedBufferAttribute} */ (instanceStart.constructor);
  const buffer = new Buffer(ends, 8, 1);
  geometry.setAttribute("webvizStart", new Attribute(buffer, 4, 0));
  geometry.setAttribute("webvizEnd", new Attribute(buffer, 4, 4));
}

// The unit vector along a segment, zero if that has no length.
/**
 * @param {ArrayLike<number>} xyz
 * @param {number} number
 * @param {number[]} into
 */
function direction(xyz, number, into) {
  for (let axis = 0; axis < 3; axis++) {
    into[axis] = xyz[6 * number + 3 + axis] - xyz[6 * number + axis];
  }
  const length = Math.hypot(...into) || 1;
  for (let axis = 0; axis < 3; axis++) into[axis] /= length;
}

// Lines with a width in metres are drawn twice, the second time with smooth edges: transparent ones
// only then. Grids without a colour of their own have that of the theme.
/** @param {LineMaterial} material */
function blend(material) {
  const { linewidth, worldUnits, defines } = material;
  const mark = markOf(linewidth);
  const clear = mark % OF_THEME;
  if (mark >= OF_THEME) paint(material.color, scheme().grid);
  material.opacity = 1 - clear / 255;
  if ("VISER_LINE_FRINGE" in defines) return;
  material.visible = !(worldUnits && clear);
  material.transparent = clear > 0;
  material.depthWrite = clear === 0;
}

export function install() {
  viser.beforeEveryRender((gl, scene) => {
    scene.traverse(({ isLineSegments2, geometry, material }) => {
      if (!isLineSegments2 || !geometry) return;
      if (material.worldUnits && !geometry.attributes.webvizStart) markEnds(geometry);
      blend(material);
      if (material.webviz) return;
      material.webviz = true;
      material.vertexShader = passing(material.vertexShader);
      material.fragmentShader = square(material.fragmentShader);
      material.needsUpdate = true;
    });
  });
}
