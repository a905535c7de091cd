// The canvas of a pane with the scene over and under a picture, as the camera sees it that took the
// picture. It has the same functions as that of a pane without the scene, see picture.js.

import * as viser from "webviz/viser_page.js";
import { contextOf } from "webviz/dom.js";
import { undistort, straight } from "webviz/images/undistort.js";
import { boxIn, paint, placeIn } from "webviz/images/camera_overlay.js";
import { eachPicture } from "webviz/scene/second_camera.js";
import { makePicture } from "webviz/images/picture.js";

/** @import {Picture, PictureListener} from "webviz/images/picture.js" */
/** @import {PictureCamera, PictureWarp} from "webviz/messages.js" */
/** @import {Vec2} from "webviz/types.js" */

const SCENE_MS = 100; // at most so often for what moves in the scene; for each picture anyway

/** @typedef {{camera: PictureCamera | null, warp: PictureWarp | null, size: Vec2}} PictureView */

/**
 * `drawn()` is called whenever there is another picture, `fail(sentence)` if a video is damaged.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {PictureListener} listener
 * @returns {Picture}
 */
export function makeCamera(canvas, { onDraw, fail }) {
  const context = contextOf(canvas);
  const sheet = document.createElement("canvas");
  const undistorted = contextOf(document.createElement("canvas"));
  const picture = makePicture(sheet, { onDraw: take, fail });
  /** @type {PictureCamera | null} */
  let camera = null;
  /** @type {PictureWarp | null} */
  let warp = null;
  /** @type {string[]} */
  let hidden = [];
  const view = () => ({ camera, warp, size: picture.size() });
  const painting = paintNowAndThen(canvas, {
    isReady: () => picture.size()[0] > 0,
    paint() {
      const image = warp ? undistorted.canvas : sheet;
      paint(context, { image, size: picture.size(), camera, hidden });
    },
  });

  function prepare() {
    if (warp) {
      Object.assign(undistorted.canvas, { width: sheet.width, height: sheet.height });
      undistort(sheet, warp, undistorted);
    }
    painting.ask();
  }

  function take() {
    prepare();
    onDraw();
  }

  return {
    size: picture.size,
    async take(header, data) {
      camera = header.camera ?? null;
      if (header.warp !== undefined) warp = header.warp;
      if (!camera) warp = null;
      if (header.is_same) prepare();
      return picture.take(header, data);
    },
    /** Displays that are not drawn, by their ids. */
    hide(ids) {
      if (ids.join() !== hidden.join()) painting.ask();
      hidden = ids;
    },
    width: () => widthIn(canvas, view()),
    pixelAt: (pointer) => pixelUnder(canvas, view(), pointer),
    placeIn: (width, height) => placeIn(view(), width, height),
    colorAt: picture.colorAt,
    close() {
      painting.end();
      picture.close();
    },
  };
}

/**
 * Calls `paint()` in the frames of the scene: in the next one after `ask()`, else now and then, since most
 * have nothing to do with what this camera sees. The canvas has the size of its place in the window then.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {{isReady: () => boolean, paint: () => void}} picture
 */
function paintNowAndThen(canvas, { isReady, paint }) {
  let isDue = false;
  let painted = 0;
  let timer = 0;

  function ask() {
    isDue = true;
    viser.requestRender();
  }

  function frame() {
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((length) =>
      Math.round(length * devicePixelRatio),
    );
    if (!width || !height || !isReady()) return;
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
    paint();
  }

  const end = eachPicture(frame);
  const resized = new ResizeObserver(ask);
  resized.observe(canvas);
  return {
    ask,
    end() {
      clearTimeout(timer);
      end();
      resized.disconnect();
    },
  };
}

/**
 * Width of the picture on the screen, in its pixels.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {PictureView} view
 */
function widthIn({ clientWidth, clientHeight }, { camera, size }) {
  if (!size[0]) return clientWidth * devicePixelRatio;
  const box = boxIn(camera, size, clientWidth, clientHeight);
  return Math.max(1, box.width * devicePixelRatio);
}

/**
 * Column and row of the picture under a pointer, null beside it.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {PictureView} view
 * @param {{clientX: number, clientY: number}} pointer
 * @returns {Vec2 | null}
 */
function pixelUnder(canvas, { camera, warp, size }, { clientX, clientY }) {
  const [wide, tall] = size;
  const pane = canvas.getBoundingClientRect();
  if (!wide || !pane.width) return null;
  const box = boxIn(camera, size, pane.width, pane.height);
  /** @type {Vec2} */
  const place = [
    (clientX - pane.left - box.left) / box.width,
    (clientY - pane.top - box.top) / box.height,
  ];
  const share = warp ? straight(warp, place) : place;
  if (!share) return null;
  const [x, y] = [Math.floor(share[0] * wide), Math.floor(share[1] * tall)];
  return x >= 0 && y >= 0 && x < wide && y < tall ? [x, y] : null;
}
