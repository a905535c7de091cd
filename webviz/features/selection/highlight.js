// Marks what is selected, over the scene of this page alone.

import { contextOf, el } from "webviz/dom.js";
import { outlineOf } from "webviz/scene/picking/outline.js";
import { finder } from "webviz/scene/picking/things.js";
import * as viser from "webviz/viser_page.js";
import { makeLayer } from "webviz/tools/layer.js";
import * as selection from "webviz/tools/selection.js";

/** @import {Vector3} from "three" */
/** @import {Outline, Selected, Vec2} from "webviz/types.js" */

const POINT_PX = 5; // half of the square around a point
const OLD_MS = 10_000; // how long something is marked that is not drawn any more

export function install() {
  const draw = drawing();
  let isEmpty = true;
  selection.onChange(() => viser.requestRender());
  viser.beforeRender(() => {
    const picks = [...selection.all().values()];
    if (picks.length || !isEmpty) draw(picks);
    isEmpty = !picks.length;
  });
}

/** The middle of all that is marked, in three.js' coordinates, or null. */
export function middle() {
  const find = finder();
  const points = [...selection.all().values()].flatMap(
    (pick) => outlineOf(pick, find, selection.moves(pick))?.points ?? [],
  );
  if (!points.length) return null;
  const sum = points.reduce((whole, point) => whole.add(point), points[0].clone().set(0, 0, 0));
  return sum.divideScalar(points.length);
}

/** Returns what marks picks, in a layer that is there from the first on. */
function drawing() {
  /** @type {ReturnType<typeof makeSheet> | null} */
  let sheet = null;
  let timer = 0;
  const drawAgain = () => {
    timer = 0;
    viser.requestRender();
  };
  return (/** @type {Selected[]} */ picks) => {
    sheet ??= makeSheet();
    const pen = sheet.clear();
    const { now, old } = outlinesOf(picks);
    if (old.length) timer ||= setTimeout(drawAgain, OLD_MS);
    stroke(pen, now, []);
    stroke(pen, old, [2, 3]);
  };
}

/** A canvas as large as the scene; `clear()` returns its pen. */
function makeSheet() {
  const canvas = el("canvas", { class: "wv-highlight" });
  const layer = makeLayer("highlight", canvas);
  return {
    clear() {
      layer.place();
      const { clientWidth: wide, clientHeight: tall } = viser.canvas();
      const [width, height] = [wide, tall].map((size) => Math.round(size * devicePixelRatio));
      if (canvas.width !== width || canvas.height !== height)
        Object.assign(canvas, { width, height });
      const pen = contextOf(canvas);
      pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
      pen.clearRect(0, 0, wide, tall);
      return pen;
    },
  };
}

/**
 * The outlines of what is drawn now, and of what is not drawn any more.
 *
 * @param {Selected[]} picks
 */
function outlinesOf(picks) {
  const find = finder();
  /** @type {{now: Outline[], old: Outline[]}} */
  const outlines = { now: [], old: [] };
  for (const pick of picks) {
    const outline = outlineOf(pick, find, selection.moves(pick));
    if (!outline) continue;
    const oldSince = outline.isOld ? (pick.oldSince ?? performance.now()) : null;
    pick.oldSince = oldSince;
    if (oldSince === null) outlines.now.push(outline);
    else if (performance.now() - oldSince < OLD_MS) outlines.old.push(outline);
  }
  return outlines;
}

/**
 * First a dark line that is wider: legible on any ground.
 *
 * @param {CanvasRenderingContext2D} pen
 * @param {Outline[]} outlines
 * @param {number[]} dash
 */
function stroke(pen, outlines, dash) {
  if (!outlines.length) return;
  pen.beginPath();
  for (const outline of outlines) trace(pen, outline);
  pen.setLineDash(dash);
  const style = getComputedStyle(pen.canvas);
  for (const look of [
    { strokeStyle: style.getPropertyValue("--wv-rim"), lineWidth: 3.5 },
    { strokeStyle: style.getPropertyValue("--wv-picked"), lineWidth: 1.5 },
  ]) {
    Object.assign(pen, look);
    pen.stroke();
  }
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {Outline} outline
 */
function trace(pen, { points, edges }) {
  const places = points.map(placeOf);
  for (const [from, to] of edges) {
    if (!places[from] || !places[to]) continue;
    pen.moveTo(...places[from]);
    pen.lineTo(...places[to]);
  }
  if (edges.length || !places[0]) return;
  const [x, y] = places[0];
  pen.rect(x - POINT_PX, y - POINT_PX, 2 * POINT_PX, 2 * POINT_PX);
}

/**
 * @param {Vector3} point
 * @returns {Vec2 | null}
 */
function placeOf(point) {
  const [camera, { clientWidth, clientHeight }] = [viser.camera(), viser.canvas()];
  if (point.clone().applyMatrix4(camera.matrixWorldInverse).z >= 0) return null;
  const { x, y } = point.clone().project(camera);
  return [((x + 1) / 2) * clientWidth, ((1 - y) / 2) * clientHeight];
}
