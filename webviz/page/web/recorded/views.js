// The view of a page that was exported: what a viewer does for a browser.

import * as placing from "webviz/scene/view.js";
import { toThree } from "webviz/scene/fixed_frame.js";
import { VIEW_TYPES } from "webviz/shell/view_menus.js";
import * as viser from "webviz/viser_page.js";
import { about as turn, turnedBy } from "webviz/vectors.js";
import {
  cameraOf,
  focus,
  like,
  mimic,
  optionsOf,
  viewOf,
  zeroView,
} from "webviz/recorded/view_math.js";

/** @import {Vector3} from "three" */
/** @import {PlaceCamera} from "webviz/messages.js" */
/** @import {Vec3} from "webviz/types.js" */
/** @import {About, View, ViewRig} from "webviz/recorded/types.js" */

const FIXED = "<Fixed Frame>";
const FRAME_M = 0.5; // half of the edge of the cube around a frame that is looked at
const DIGITS = 3;

/**
 * @param {unknown} value
 * @returns {unknown}
 */
function rounded(value) {
  if (Array.isArray(value)) return value.map(rounded);
  return typeof value === "number" ? Number(value.toFixed(DIGITS)) : value;
}

/**
 * Returns `{view(), type(), acts}`: the stores of these names, and commands. `place(camera)` puts the
 * camera of the page somewhere, and `changed()` is called when the view is another one.
 *
 * @param {About} about
 * @param {(camera: PlaceCamera) => void} place
 * @param {() => void} changed
 */
export function views(about, place, changed) {
  let number = 0;

  placing.onShow(changed);

  /** @param {View} view */
  function show(view) {
    const target = view.target_frame;
    const node = target === FIXED ? "" : about.frame_nodes[target];
    if (node === undefined) throw new Error(`The poses of ${target} are not in this file.`);
    const [position, look_at] = cameraOf(view, size().height);
    number += 1;
    place({
      type: "PlaceCamera",
      number,
      view: view.type,
      options: optionsOf(view.type, view),
      frame: node,
      position,
      look_at,
      scale: view.scale ?? null,
    });
  }

  /** @param {{low: Vec3, high: Vec3}} box */
  function lookAt(box) {
    const view = now();
    show(focus(view, rigOf(about, view), box, size()));
  }

  return {
    acts: {
      /** @param {{view: string | View}} fields */
      ShowView: ({ view }) => show(typeof view === "string" ? about.views[view] : view),
      ResetView: () => show(zeroView(blank())),
      /** @param {{key: string, value: any}} fields */
      ChangeView: ({ key, value }) => show(otherView(about, key, value)),
      /** @param {{frame: string}} fields */
      FocusFrame: ({ frame }) => lookAt(boxAround(about, frame)),
    },
    lookAt,
    type: () =>
      placing.type() === "" ? {} : { type: placing.type(), target_frame: placing.targetFrame() },
    view: () => (placing.type() === "" ? {} : valuesOf(about, now())),
  };
}

const size = () => ({
  width: viser.canvas().clientWidth,
  height: viser.canvas().clientHeight,
});

/** The type and the options of the view. @returns {View} */
const blank = () => /** @type {View} */ ({ type: placing.type(), ...placing.options() });

/** The view as the camera has it now. @returns {View} */
function now() {
  const controls = viser.controls();
  const inverse = toThree().clone().invert();
  const at = viser.camera().position;
  /** @param {Vector3} point */
  const xyz = (point) => /** @type {Vec3} */ (point.applyMatrix4(inverse).toArray());
  const position = xyz(controls.getPosition(at.clone()));
  const lookAt = xyz(controls.getTarget(at.clone()));
  return viewOf(blank(), [position, lookAt], size().height);
}

/**
 * The pose that the view is relative to: of its target frame, as far as its type follows that.
 *
 * @param {About} about
 * @param {View} view
 * @returns {ViewRig}
 */
function rigOf(about, { type, target_frame, invert_z_axis }) {
  const node = target_frame === FIXED ? undefined : viser.node(about.frame_nodes[target_frame]);
  /** @type {ViewRig} */
  const rig = { origin: [0, 0, 0], wxyz: [1, 0, 0, 0] };
  if (node) {
    node.updateWorldMatrix(true, false);
    const pose = toThree().clone().invert().multiply(node.matrixWorld);
    const m = pose.elements;
    rig.origin = [m[12], m[13], m[14]];
    if (type === "FrameAligned") {
      const { x, y, z, w } = node.quaternion.clone().setFromRotationMatrix(pose);
      rig.wxyz = [w, x, y, z];
    }
    if (type === "ThirdPersonFollower") rig.wxyz = turn([0, 0, 1], Math.atan2(m[1], m[0]));
  }
  if (invert_z_axis) rig.wxyz = turnedBy(rig.wxyz, [0, 1, 0, 0]);
  return rig;
}

/**
 * The view with another type or another value of an option.
 *
 * @param {About} about
 * @param {string} key
 * @param {any} value
 * @returns {View}
 */
function otherView(about, key, value) {
  const view = now();
  /** @param {View} other to be placed so that it looks like this one */
  const seenBy = (other) =>
    mimic(view, rigOf(about, view), other, rigOf(about, other), size().height);
  if (key === "type") {
    if (!VIEW_TYPES.includes(value)) throw new Error(`Unknown view type \`${value}\`.`);
    return seenBy(like(value, view));
  }
  if (key === "target_frame" && view.type !== "FrameAligned")
    return seenBy({ ...blank(), target_frame: value });
  const other = { ...view, [key]: value };
  return key === "point_towards" ? zeroView(other) : other;
}

/**
 * @param {About} about
 * @param {string} frame
 * @returns {{low: Vec3, high: Vec3}}
 */
function boxAround(about, frame) {
  if (!(frame in about.frame_nodes)) throw new Error(`The poses of ${frame} are not in this file.`);
  const [x, y, z] = rigOf(about, { type: "Orbit", target_frame: frame }).origin;
  return {
    low: [x - FRAME_M, y - FRAME_M, z - FRAME_M],
    high: [x + FRAME_M, y + FRAME_M, z + FRAME_M],
  };
}

/**
 * The store of a view.
 *
 * @param {About} about
 * @param {View} view
 */
function valuesOf(about, view) {
  const fields = Object.entries(view).map(([key, value]) => [`value.${key}`, rounded(value)]);
  return {
    declared: about.view_forms[view.type] ?? [],
    types: VIEW_TYPES,
    ...Object.fromEntries(fields),
  };
}
