// The ground of the scene, the plane z = 0 of the fixed frame, as the camera sees it.

import constants from "../constants.js";
import * as viser from "../viser_page.js";

const FARTHEST = 1e6; // metres

const vector = (xyz) => viser.camera().position.clone().fromArray(xyz);

function toThree() {
  const world = viser.node(constants.ROOT);
  world.updateWorldMatrix(true, false);
  return world.matrixWorld;
}

/** The point of the ground below a point of the window, in metres, or null above the horizon. */
export function groundAt(x, y) {
  const box = viser.canvas().getBoundingClientRect();
  const [across, down] = [(x - box.left) / box.width, (y - box.top) / box.height];
  const caster = new (viser.Raycaster())();
  caster.setFromCamera({ x: across * 2 - 1, y: 1 - down * 2 }, viser.camera());
  const { origin, direction } = caster.ray.applyMatrix4(toThree().clone().invert());
  const steps = -origin.z / direction.z;
  if (!(steps > 0 && steps < FARTHEST)) return null;
  return [...origin.addScaledVector(direction, steps).toArray().slice(0, 2), 0];
}

/** A point of three.js in the coordinates of the fixed frame. */
export const toFixedFrame = (point) => point.clone().applyMatrix4(toThree().clone().invert()).toArray();

/** Where a point of the ground is on the canvas, in CSS pixels, or null behind the camera. */
export function onCanvas(point) {
  const [camera, canvas] = [viser.camera(), viser.canvas()];
  const place = vector(point).applyMatrix4(toThree());
  if (place.clone().applyMatrix4(camera.matrixWorldInverse).z >= 0) return null;
  const { x, y } = place.project(camera);
  return [((x + 1) / 2) * canvas.clientWidth, ((1 - y) / 2) * canvas.clientHeight];
}
