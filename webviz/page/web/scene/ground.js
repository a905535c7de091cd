// Places in the fixed frame, whose plane z = 0 is the ground, as the camera sees them.

import { toThree } from "webviz/scene/fixed_frame.js";
import { hit } from "webviz/scene/mouse.js";
import { casterAt } from "webviz/scene/rays.js";
import * as viser from "webviz/viser_page.js";

/** @import {Ray, Vector3} from "three" */
/** @import {Vec2, Vec3} from "webviz/types.js" */

const FARTHEST = 1e6; // metres
const STEEP = 0.01; // square of the sine of an angle to the vertical

/**
 * @param {Vec3} xyz
 * @returns {Vector3}
 */
const vector = (xyz) => viser.camera().position.clone().fromArray(xyz);

/**
 * Return where a plane z = height is below a point of the window, in metres; null above its horizon.
 *
 * @param {Vec2} xy
 * @param {number} height
 * @returns {Vec3 | null}
 */
export function planeAt(xy, height) {
  const { origin, direction } = rayAt(xy);
  const steps = (height - origin.z) / direction.z;
  if (!(steps > 0 && steps < FARTHEST)) return null;
  const [x, y] = origin.addScaledVector(direction, steps).toArray();
  return [x, y, height];
}

/**
 * The point of the ground below a point of the window, in metres, or null above the horizon.
 *
 * @param {number} x
 * @param {number} y
 */
export const groundAt = (x, y) => planeAt([x, y], 0);

/**
 * The point of a surface, or of the ground, below a point of the window, in metres, or null.
 *
 * @param {Vec2} xy
 * @returns {Vec3 | null}
 */
export function surfaceAt(xy) {
  const surface = hit(xy);
  if (surface?.object) return toFixedFrame(surface.point);
  return planeAt(xy, 0);
}

/**
 * The height of a vertical line, through a point, next to what is below a point of the window. Seen
 * from above, where the line is a point, a pixel up is as high as it is wide. Null if it is too far
 * away.
 *
 * @param {Vec2} xy
 * @param {Vec3} foot
 */
export function heightAt(xy, [x, y, z]) {
  const { origin, direction } = rayAt(xy);
  const flat = direction.x ** 2 + direction.y ** 2;
  if (flat < STEEP) {
    const [here, there] = [onCanvas([x, y, z]), onCanvas([x + 0.01, y, z])];
    if (here === null || there === null) return null;
    return (-0.01 * xy[1]) / Math.hypot(there[0] - here[0], there[1] - here[1]);
  }
  const steps = ((x - origin.x) * direction.x + (y - origin.y) * direction.y) / flat;
  const height = origin.z + steps * direction.z;
  return steps > 0 && Math.abs(height) < FARTHEST ? height : null;
}

// Through a point of the window, in the fixed frame.
/**
 * @param {Vec2} xy
 * @returns {Ray}
 */
const rayAt = (xy) => casterAt(xy).ray.applyMatrix4(toThree().clone().invert());

/**
 * A point of three.js in the coordinates of the fixed frame.
 *
 * @param {Vector3} point
 * @returns {Vec3}
 */
export const toFixedFrame = (point) =>
  point.clone().applyMatrix4(toThree().clone().invert()).toArray();

/**
 * Return where a point of the fixed frame is on the canvas, in CSS pixels, or null behind the camera.
 *
 * @param {Vec3} point
 * @returns {Vec2 | null}
 */
export function onCanvas(point) {
  const [camera, canvas] = [viser.camera(), viser.canvas()];
  const place = vector(point).applyMatrix4(toThree());
  if (place.clone().applyMatrix4(camera.matrixWorldInverse).z >= 0) return null;
  const { x, y } = place.project(camera);
  return [((x + 1) / 2) * canvas.clientWidth, ((1 - y) / 2) * canvas.clientHeight];
}
