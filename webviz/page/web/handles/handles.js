// Handles of displays that people move in the scene.

import * as known from "webviz/handles/known.js";
import * as poses from "webviz/handles/poses.js";

export function install() {
  known.install();
  poses.install();
}
