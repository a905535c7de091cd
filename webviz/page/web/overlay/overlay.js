// Overlays that explain the scene: axes, scale, legend, what is under the mouse, rates.

import { places } from "../shell/shell.js";
import * as gizmo from "./gizmo.js";
import * as legend from "./legend.js";
import * as pointer from "./pointer.js";
import * as rates from "./rates.js";
import * as scaleBar from "./scale_bar.js";
import * as slowLink from "./slow_link.js";

export function install() {
  places.status.append(rates.build(), slowLink.build(), gizmo.build());
  places.pointer.append(pointer.build());
  places.legend.append(legend.build(), scaleBar.build());
}
