// The arrow of a pose, drawn over the scene.

import { onCanvas } from "webviz/scene/ground.js";
import { canvas } from "webviz/viser_page.js";

/** @import {Vec2, Vec3} from "webviz/types.js" */

// RViz's arrow, in metres: a shaft and a head. It is never too small to see, nor too large.
const SHAFT = [2.0, 0.1];
const HEAD = [0.5, 0.175];
const SHORTEST_PX = 60;
const LONGEST = 0.35; // of the height of the scene

/**
 * The corners of the arrow of a pose on the canvas, in pixels, as large as RViz's or a part of that;
 * null if it is not in front.
 *
 * @param {Vec3} point
 * @param {number} yaw
 * @param {number} [part]
 * @returns {Vec2[] | null}
 */
export function arrowAt([x, y, z], yaw, part = 1) {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  const from = onCanvas([x, y, z]);
  const to = onCanvas([x + 0.01 * c, y + 0.01 * s, z]);
  if (from === null || to === null) return null;
  const perMeter = 100 * Math.hypot(to[0] - from[0], to[1] - from[1]);
  const length = SHAFT[0] + HEAD[0];
  const longest = LONGEST * canvas().clientHeight;
  const lengthPx = part * Math.min(Math.max(length * perMeter, SHORTEST_PX), longest);
  const scale = perMeter > 0 ? lengthPx / (length * perMeter) : 1;
  const shape = [
    [0, SHAFT[1]],
    [SHAFT[0], SHAFT[1]],
    [SHAFT[0], HEAD[1]],
    [length, 0],
    [SHAFT[0], -HEAD[1]],
    [SHAFT[0], -SHAFT[1]],
    [0, -SHAFT[1]],
  ];
  const corners = shape.map(([ahead, left]) =>
    onCanvas([x + scale * (ahead * c - left * s), y + scale * (ahead * s + left * c), z]),
  );
  const points = corners.filter((corner) => corner !== null);
  return points.length === corners.length ? points : null;
}
