// The view of a page that was exported: what a viewer does for a browser.

import * as placing from "../scene/view.js";
import { toThree } from "../scene/fixed_frame.js";
import { VIEW_TYPES } from "../shell/view_menus.js";
import * as viser from "../viser_page.js";
import { cameraOf, focus, mimic, viewOf, zeroView } from "./view_math.js";

/** @import {PlaceCamera} from "../messages.js" */
/** @import {Three, Vec3} from "../types.js" */
/** @import {About, View, ViewRig} from "./types.js" */

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
  let frame = ""; // the target frame
  let number = 0;

  placing.onShow(() => {
    frame = placing.targetFrame();
    changed();
  });

  const size = () => ({
    width: viser.canvas().clientWidth,
    height: viser.canvas().clientHeight,
  });

  /** The view as the camera has it now. @returns {View} */
  function now() {
    const controls = viser.controls();
    const inverse = toThree().clone().invert();
    const at = viser.camera().position;
    /** @param {Three} point */
    const xyz = (point) => /** @type {Vec3} */ (point.applyMatrix4(inverse).toArray());
    const position = xyz(controls.getPosition(at.clone()));
    const lookAt = xyz(controls.getTarget(at.clone()));
    return viewOf(placing.type(), frame, [position, lookAt], size().height);
  }

  /**
   * @param {string} type
   * @param {string} target
   * @returns {ViewRig}
   */
  function rigOf(type, target) {
    const node = target === FIXED ? undefined : viser.node(about.frame_nodes[target]);
    if (!node) return { origin: [0, 0, 0], yaw: 0 };
    node.updateWorldMatrix(true, false);
    const m = toThree().clone().invert().multiply(node.matrixWorld).elements;
    const yaw = type === "ThirdPersonFollower" ? Math.atan2(m[1], m[0]) : 0;
    return { origin: [m[12], m[13], m[14]], yaw };
  }

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
      target_frame: target,
      frame: node,
      turns: view.type === "ThirdPersonFollower",
      position,
      look_at,
      scale: view.scale ?? null,
    });
  }

  /** @param {{low: Vec3, high: Vec3}} box */
  function lookAt(box) {
    const view = now();
    show(focus(view, rigOf(view.type, frame), box, size()));
  }

  const acts = {
    /** @param {{view: string | View}} fields */
    ShowView: ({ view }) => show(typeof view === "string" ? about.views[view] : view),
    ResetView: () => show(zeroView(placing.type(), frame)),
    /** @param {{key: string, value: any}} fields */
    ChangeView({ key, value }) {
      const view = now();
      const { height } = size();
      if (key === "type") {
        if (!VIEW_TYPES.includes(value)) throw new Error(`Unknown view type \`${value}\`.`);
        show(mimic(view, rigOf(view.type, frame), value, frame, rigOf(value, frame), height));
      } else if (key === "target_frame") {
        const { type } = view;
        show(mimic(view, rigOf(type, frame), type, value, rigOf(type, value), height));
      } else show({ ...view, [key]: value });
    },
    /** @param {{frame: string}} fields */
    FocusFrame({ frame: wanted }) {
      if (!(wanted in about.frame_nodes))
        throw new Error(`The poses of ${wanted} are not in this file.`);
      const [x, y, z] = rigOf("Orbit", wanted).origin;
      lookAt({
        low: [x - FRAME_M, y - FRAME_M, z - FRAME_M],
        high: [x + FRAME_M, y + FRAME_M, z + FRAME_M],
      });
    },
  };

  return {
    acts,
    lookAt,
    type: () => (placing.type() === "" ? {} : { type: placing.type(), target_frame: frame }),
    view() {
      if (placing.type() === "") return {};
      const { type, ...values } = now();
      const told = Object.entries({ type, ...values }).map(([key, value]) => [
        `value.${key}`,
        rounded(value),
      ]);
      return {
        declared: about.view_forms[type] ?? [],
        types: VIEW_TYPES,
        ...Object.fromEntries(told),
      };
    },
  };
}
