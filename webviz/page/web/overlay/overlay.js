// Overlays that explain the scene: axes, scale, legend, what is under the mouse, rates.

import { places } from "webviz/shell/shell.js";
import { videoButton } from "webviz/shell/video.js";
import * as attribution from "webviz/overlay/attribution.js";
import * as gizmo from "webviz/overlay/gizmo.js";
import * as legend from "webviz/overlay/legend.js";
import * as pointer from "webviz/overlay/pointer.js";
import * as rates from "webviz/overlay/rates.js";
import * as scaleBar from "webviz/overlay/scale_bar.js";
import * as slowLink from "webviz/overlay/slow_link.js";

const elements = new Map();

/**
 * Adds an overlay, or replaces that of the same name.
 *
 * @param {"status" | "pointer" | "legend" | "cards" | "scene"} place
 * @param {string} name
 * @param {Element} element
 */
export function overlay(place, name, element) {
  elements.get(name)?.remove();
  elements.set(name, element);
  places[place].append(element);
}

export function install() {
  overlay("status", "rates", rates.build());
  overlay("status", "slow link", slowLink.build());
  overlay("status", "video", videoButton());
  overlay("status", "gizmo", gizmo.build());
  overlay("pointer", "pointer", pointer.build());
  overlay("legend", "legend", legend.build());
  overlay("legend", "scale bar", scaleBar.build());
  overlay("legend", "attribution", attribution.build());
}
