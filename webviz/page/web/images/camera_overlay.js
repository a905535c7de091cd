// A picture with the scene over and under it, as the camera sees it that took the picture.

import { drawSecond } from "webviz/scene/second_camera.js";
import { bent } from "webviz/images/undistort.js";

/** @import {PictureCamera, PictureWarp} from "webviz/messages.js" */
/** @import {Places} from "webviz/images/marks.js" */
/** @import {Vec2} from "webviz/types.js" */

/**
 * Fills a 2D context. `image` shows what the camera sees, undistorted; `size` is that of the picture;
 * `camera` is that of the server, null for the picture alone; `hidden` has ids of displays to leave out.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {{image: HTMLCanvasElement, size: Vec2, camera: PictureCamera | null, hidden: string[]}} shown
 */
export function paint(context, { image, size, camera, hidden }) {
  const { width, height } = context.canvas;
  const box = boxIn(camera, size, width, height);
  const draw = () => context.drawImage(image, box.left, box.top, box.width, box.height);
  context.globalAlpha = 1;
  context.clearRect(0, 0, width, height);
  if (!camera) return draw();
  if (camera.is_background) draw();
  const { position, wxyz, far } = camera;
  const edges = edgesOf(camera, width, height);
  drawSecond(context, width, height, { position, wxyz, edges, far, hidden });
  context.globalAlpha = camera.overlay;
  if (camera.overlay > 0) draw();
  context.globalAlpha = 1;
}

/**
 * Return where the picture is, in pixels of a pane so large.
 *
 * @param {PictureCamera | null} camera
 * @param {Vec2} size
 * @param {number} width
 * @param {number} height
 */
export function boxIn(camera, size, width, height) {
  const [wide, tall] = camera ? extent(camera, width, height) : fitting(size, width, height);
  const [left, top, right, bottom] = camera ? camera.part : [0, 0, 1, 1];
  return {
    left: width * ((1 - wide) / 2 + left * wide),
    top: height * ((1 - tall) / 2 + top * tall),
    width: width * wide * (right - left),
    height: height * tall * (bottom - top),
  };
}

/**
 * The places of the pixels of a picture in a pane so large.
 *
 * @param {{camera: PictureCamera | null, warp: PictureWarp | null, size: Vec2}} shown
 * @param {number} width
 * @param {number} height
 * @returns {Places}
 */
export function placeIn({ camera, warp, size }, width, height) {
  const box = boxIn(camera, size, width, height);
  return {
    width,
    scale: box.width / size[0],
    at(x, y) {
      /** @type {Vec2} */
      const share = [x / size[0], y / size[1]];
      const [across, down] = (warp && bent(warp, share)) ?? share;
      return [box.left + across * box.width, box.top + down * box.height];
    },
  };
}

/**
 * @param {Vec2} size
 * @param {number} width
 * @param {number} height
 * @returns {Vec2}
 */
function fitting([wide, tall], width, height) {
  const scale = Math.min(width / wide, height / tall);
  return [(wide * scale) / width, (tall * scale) / height];
}

/**
 * The size of all that the camera sees at a zoom of 1, as shares of the pane; as RViz does it.
 *
 * @param {PictureCamera} camera
 * @param {number} width
 * @param {number} height
 * @returns {Vec2}
 */
function extent({ size, focal, zoom }, width, height) {
  const aspect = size[0] / focal[0] / (size[1] / focal[1]);
  const own = width / height;
  return aspect > own ? [zoom, (zoom / aspect) * own] : [(zoom / own) * aspect, zoom];
}

/**
 * Left, right, top and bottom of what the pane shows 1 m ahead of the camera, y upwards. The corner of
 * the first pixel is at -0.5, -0.5.
 *
 * @param {PictureCamera} camera
 * @param {number} width
 * @param {number} height
 */
function edgesOf(camera, width, height) {
  const { size, focal, principal } = camera;
  const [wide, tall] = extent(camera, width, height);
  /**
   * @param {0 | 1} axis
   * @param {number} share
   * @param {number} side
   */
  const at = (axis, share, side) =>
    (((1 + side / share) * size[axis]) / 2 - 0.5 - principal[axis]) / focal[axis];
  return [at(0, wide, -1), at(0, wide, 1), -at(1, tall, -1), -at(1, tall, 1)];
}
