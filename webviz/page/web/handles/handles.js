// Handles of displays that people move in the scene.

import * as known from "./known.js";
import * as poses from "./poses.js";

export function install() {
  known.install();
  poses.install();
}
