// The canvas of a pane with the scene over and under a picture, as the camera sees it that took the
// picture. It has the same functions as that of a pane without the scene, see picture.js.

import * as viser from "webviz/viser_page.js";
import { contextOf } from "webviz/dom.js";
import { undistort, straight } from "webviz/images/undistort.js";
import { boxIn, paint, placeIn } from "webviz/images/camera_overlay.js";
import { eachPicture } from "webviz/scene/second_camera.js";
import { makePicture } from "webviz/images/picture.js";

/** @import {Picture, PictureListener} from "webviz/images/picture.js" */
/** @import {PictureCamera, PictureHeader, PictureWarp} from "webviz/messages.js" */
/** @import {Vec2} from "webviz/types.js" */

const SCENE_MS = 100; // at most so often for what moves in the scene; for each picture anyway

/**
 * `drawn()` is called whenever there is another picture, `fail(sentence)` if a video is damaged.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {PictureListener} listener
 * @returns {Picture}
 */
export function makeCamera(canvas, { drawn, fail }) {
  const context = contextOf(canvas);
  const sheet = document.createElement("canvas");
  const undistorted = contextOf(document.createElement("canvas"));
  const picture = makePicture(sheet, { drawn: take, fail });
  /** @type {PictureCamera | null} */
  let camera = null;
  /** @type {PictureWarp | null} */
  let warp = null;
  /** @type {string[]} */
  let hidden = [];
  let isDue = false;
  let painted = 0;
  let timer = 0;

  function prepare() {
    if (warp) {
      Object.assign(undistorted.canvas, { width: sheet.width, height: sheet.height });
      undistort(sheet, warp, undistorted);
    }
    ask();
  }

  function take() {
    prepare();
    drawn();
  }

  function ask() {
    isDue = true;
    viser.requestRender();
  }

  // Called in each frame of the scene; most have nothing to do with what this camera sees.
  function frame() {
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((length) =>
      Math.round(length * devicePixelRatio),
    );
    if (!width || !height || !picture.size()[0]) return;
    const rest = painted + SCENE_MS - performance.now();
    if (!isDue && rest > 0) {
      timer ||= setTimeout(ask, rest);
      return;
    }
    clearTimeout(timer);
    timer = 0;
    isDue = false;
    painted = performance.now();
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, { width, height });
    paint(context, {
      image: warp ? undistorted.canvas : sheet,
      size: picture.size(),
      camera,
      hidden,
    });
  }

  const end = eachPicture(frame);
  const resized = new ResizeObserver(ask);
  resized.observe(canvas);

  return {
    size: picture.size,
    /**
     * @param {PictureHeader} header
     * @param {Uint8Array<ArrayBuffer>} data
     */
    async take(header, data) {
      camera = header.camera ?? null;
      if (header.warp !== undefined) warp = header.warp;
      if (!camera) warp = null;
      if (header.is_same) prepare();
      return picture.take(header, data);
    },
    /**
     * Displays that are not drawn, by their ids.
     *
     * @param {string[]} ids
     */
    hide(ids) {
      if (ids.join() !== hidden.join()) ask();
      hidden = ids;
    },
    width: () => {
      const { clientWidth, clientHeight } = canvas;
      if (!picture.size()[0]) return clientWidth * devicePixelRatio;
      return Math.max(
        1,
        boxIn(camera, picture.size(), clientWidth, clientHeight).width * devicePixelRatio,
      );
    },
    /**
     * @param {{clientX: number, clientY: number}} pointer
     * @returns {Vec2 | null}
     */
    pixelAt({ clientX, clientY }) {
      const [wide, tall] = picture.size();
      const pane = canvas.getBoundingClientRect();
      if (!wide || !pane.width) return null;
      const box = boxIn(camera, picture.size(), pane.width, pane.height);
      /** @type {Vec2} */
      const place = [
        (clientX - pane.left - box.left) / box.width,
        (clientY - pane.top - box.top) / box.height,
      ];
      const share = warp ? straight(warp, place) : place;
      if (!share) return null;
      const [x, y] = [Math.floor(share[0] * wide), Math.floor(share[1] * tall)];
      return x >= 0 && y >= 0 && x < wide && y < tall ? [x, y] : null;
    },
    placeIn: (width, height) => placeIn({ camera, warp, size: picture.size() }, width, height),
    colorAt: picture.colorAt,
    close() {
      clearTimeout(timer);
      end();
      resized.disconnect();
      picture.close();
    },
  };
}
